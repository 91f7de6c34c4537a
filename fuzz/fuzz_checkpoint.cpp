// Resumes a rendering from a checkpoint that libFuzzer makes: its checksums are right, its contents
// arbitrary. It must be refused with InputError, or lead to some picture. Bytes: the method, then
// chunks, each after its size in two bytes.
#include <unistd.h>

#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "base/error.h"
#include "render/camera.h"
#include "render/checkpoint.h"
#include "render/preparation.h"

namespace {

namespace fs = std::filesystem;
using namespace troffer;

Scene lit_floor() {
  Scene s;
  s.materials.emplace_back();
  Mesh floor;
  floor.positions = {{-2, -2, 0}, {2, -2, 0}, {2, 2, 0}, {-2, 2, 0}};
  floor.triangles = {{0, 1, 2}, {0, 2, 3}};
  s.meshes.push_back(floor);
  Light sky;
  sky.kind = LightKind::distant;
  sky.direction = {0, 0, -1};
  sky.radiance = Rgb{1};
  s.lights.push_back(sky);
  return s;
}

struct Target {
  const PreparedScene scene{lit_floor()};
  const Camera camera = look_at({0, -1.8f, 1.2f}, {0, 0, 0}, {0, 0, 1}, 60);
  const StopFlag stop = false;
  const std::string file =
      (fs::temp_directory_path() / ("troffer_fuzz_chk_" + std::to_string(getpid()))).string();

  RenderOptions options(int method) const {
    RenderOptions o;
    o.method = method == 0 ? Method::path : method == 1 ? Method::fixed : Method::certified;
    o.width = 9;
    o.height = 5;
    o.spp = 5;
    o.max_spp = method == 1 ? 5 : 12;
    o.indirect = Indirect::none;
    o.aovs = {Aov::normal, Aov::error};
    o.threads = 1;
    return o;
  }

  void run(std::span<const uint8_t> data) const {
    RenderOptions o = options(data[0] % 3);
    const PictureKey key = picture_key("fuzz", scene.scene, camera, o, {});
    Checkpoint(file, key, {}, 1e9, {}).write([&](const Checkpoint::Add& add) {
      std::span<const uint8_t> rest = data.subspan(1);
      while (rest.size() > 2) {
        const size_t size = size_t(rest[0]) | size_t(rest[1]) << 8;
        rest = rest.subspan(2);
        const auto chunk = rest.first(std::min(size, rest.size()));
        if (!chunk.empty()) add(chunk);
        rest = rest.subspan(chunk.size());
      }
    });
    Checkpoint checkpoint(file, key, {}, 1e9, {});
    checkpoint.read();
    o.checkpoint = &checkpoint;
    render(scene, camera, o, {}, stop);
  }
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  static const Target target;
  if (size == 0) return 0;
  try {
    target.run({data, size});
  } catch (const InputError&) {
    return 0;
  }
  return 0;
}
