// Interrupted renderings that continue from a checkpoint: the same bits. Also damaged and forged
// checkpoint files.
#include "render/checkpoint.h"

#include <doctest/doctest.h>
#include <unistd.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>

#include "base/error.h"
#include "render/pictures.h"

using namespace troffer;
using namespace troffer::test;

namespace test_checkpoint {

namespace {

struct File {
  std::string path =
      (std::filesystem::temp_directory_path() / ("troffer-chk-" + std::to_string(getpid())))
          .string();
  File() { std::remove(path.c_str()); }
  ~File() { std::remove(path.c_str()); }
  std::string bytes() const {
    std::ifstream in(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  void write(const std::string& bytes) const { std::ofstream(path, std::ios::binary) << bytes; }
};

RenderOptions options_for(Method method, int max_spp) {
  RenderOptions o;
  o.method = method;
  o.width = 35;
  o.height = 17;
  o.spp = 6;  // two passes
  o.max_spp = max_spp;
  o.shadow_rays = 3;
  o.error = 0.05;
  o.kj92.sampling.tree.allowed_variance = 0.1f;
  o.aovs = {Aov::normal, Aov::direct, Aov::error, Aov::viewing_error, Aov::shadow_rays};
  o.threads = 2;
  o.kj92.radiosity.meshing.element_size = 0.4f;
  o.kj92.radiosity.meshing.patch_size = 1.2f;
  o.kj92.radiosity.unshot_fraction = 0.05f;
  return o;
}

struct Room {
  PreparedScene scene{mixed_room()};
  Camera camera = mixed_room_camera();
  PictureKey key(const RenderOptions& o) const {
    return picture_key("1.0", scene.scene, camera, o, {});
  }
};

// Renders until the share of tiles done reaches `share`; has_file: continues from the file.
RenderResult broken_off(const Room& room, RenderOptions o, const File& file, bool has_file,
                        double share, double interval) {
  Checkpoint checkpoint(file.path, room.key(o), {o.part, o.parts}, interval, {});
  if (has_file) checkpoint.read();
  o.checkpoint = &checkpoint;
  StopFlag stop = false;
  const RenderResult r = render(
      room.scene, room.camera, o, [&](double done) { stop = stop || done > share; }, stop);
  CHECK(checkpoint.failure().empty());
  return r;
}

bool is_same_work(const Counters& a, const Counters& b) {
  return a.viewing_rays == b.viewing_rays && a.surrogates == b.surrogates &&
         a.shadow_rays == b.shadow_rays && a.extension_rays == b.extension_rays &&
         a.mixed == b.mixed && a.masked == b.masked;
}

void check_resumed(const RenderOptions& o) {
  const Room room;
  CAPTURE(std::string(o.method.row().name));
  CAPTURE(o.max_spp);
  const RenderResult whole = render_now(room.scene, room.camera, o);
  const File file;
  bool is_there = false;
  // Shares of the work after cells, which take the first half.
  const double first = needs_cells(o.method, o.indirect) ? 0.5 : 0;
  for (const double share : {0.02, 0.45, 0.55, 0.7, 0.95}) {
    // Written at the end, or all the time and read as it was when a tile was done.
    const RenderResult part =
        broken_off(room, o, file, is_there, first + (1 - first) * share, share < 0.5 ? 1e9 : 0);
    CHECK(part.end == (part.is_complete ? RenderEnd::complete : RenderEnd::stopped));
    is_there = true;
  }
  const RenderResult resumed = broken_off(room, o, file, true, 2, 1e9);
  CHECK(resumed.is_complete);
  CHECK(is_identical(resumed.layers, whole.layers));
  CHECK(is_same_work(resumed.statistics.counters, whole.statistics.counters));
  // A finished picture is complete at once.
  const RenderResult again = broken_off(room, o, file, true, 2, 1e9);
  CHECK(is_identical(again.layers, whole.layers));
}

}  // namespace

TEST_CASE("a picture that is interrupted and resumed five times has the same bits") {
  for (const int max_spp : {6, 19}) {
    check_resumed(options_for(Method::path, max_spp));
    check_resumed(options_for(Method::fixed, max_spp));
    check_resumed(options_for(Method::kj92, max_spp));
  }
}

TEST_CASE(
    "resuming by default, with cells, without reflected light, and as a part gives the same bits") {
  RenderOptions o = options_for(Method::certified, 0);
  check_resumed(o);
  o.part = 2;
  o.parts = 3;
  check_resumed(o);
  o.indirect = Indirect::none;
  check_resumed(o);
}

TEST_CASE("an interruption before the first tile leaves a new checkpoint or the existing one") {
  const Room room;
  const RenderOptions o = options_for(Method::certified, 0);
  const File file;
  constexpr double in_cells = 0.01;
  const RenderResult begun = broken_off(room, o, file, false, in_cells, 1e9);
  CHECK(begun.end == RenderEnd::stopped);
  CHECK(begun.statistics.counters.viewing_rays == 0);
  const std::string of_beginning = file.bytes();
  CHECK(!of_beginning.empty());
  broken_off(room, o, file, true, 0.8, 1e9);
  const std::string of_some = file.bytes();
  CHECK(of_some.size() > of_beginning.size());
  broken_off(room, o, file, true, in_cells, 1e9);
  CHECK(file.bytes() == of_some);
  const RenderResult resumed = broken_off(room, o, file, true, 2, 1e9);
  CHECK(resumed.is_complete);
  CHECK(is_identical(resumed.layers, render_now(room.scene, room.camera, o).layers));
}

TEST_CASE("a checkpoint of another picture is refused with the reason in one line") {
  const Room room;
  const RenderOptions o = options_for(Method::fixed, 6);
  const File file;
  broken_off(room, o, file, false, 0.4, 1e9);
  const auto refusal = [&](const PictureKey& key, PictureShare share) -> std::string {
    try {
      Checkpoint(file.path, key, share, 1, {}).read();
    } catch (const InputError& e) {
      return e.reason();
    }
    return "";
  };
  CHECK(refusal(room.key(o), {}).empty());
  RenderOptions other = o;
  other.seed = 1;
  CHECK(refusal(room.key(other), {}).find("other options") != std::string::npos);
  other = o;
  other.threads = 5;
  CHECK(refusal(room.key(other), {}).empty());
  Camera moved = room.camera;
  moved.position.x += 1e-3f;
  CHECK(refusal(picture_key("1.0", room.scene.scene, moved, o, {}), {}).find("another camera") !=
        std::string::npos);
  Scene lit = mixed_room();
  lit.lights[0].radiance *= 1.001f;
  CHECK(refusal(picture_key("1.0", lit, room.camera, o, {}), {}).find("another scene") !=
        std::string::npos);
  CHECK(refusal(picture_key("1.0", room.scene.scene, room.camera, o, {1, 2, 3}), {})
            .find("--solution") != std::string::npos);
  CHECK(refusal(picture_key("1.1", room.scene.scene, room.camera, o, {}), {}).find("troffer 1.0") !=
        std::string::npos);
  CHECK(refusal(room.key(o), {2, 3}).find("--part 1/1") != std::string::npos);
  std::remove(file.path.c_str());
  CHECK(refusal(room.key(o), {}).find("cannot open") != std::string::npos);
}

TEST_CASE("damaged checkpoints are refused, for any flipped bit and any truncation") {
  const Room room;
  RenderOptions o = options_for(Method::kj92, 19);
  o.width = 20;
  o.height = 12;
  const File file;
  broken_off(room, o, file, false, 0.8, 1e9);
  const std::string good = file.bytes();
  REQUIRE(good.size() > 1000);
  const PictureKey key = room.key(o);
  const auto is_refused = [&](const std::string& bytes) {
    file.write(bytes);
    try {
      Checkpoint(file.path, key, {}, 1, {}).read();
      return false;
    } catch (const InputError&) {
      return true;
    }
  };
  CHECK(!is_refused(good));
  std::mt19937 random(1);
  for (int i = 0; i < 600; ++i) {
    std::string bad = good;
    const size_t at = i < 200 ? size_t(i) % good.size() : random() % good.size();
    if (i % 3 == 0)
      bad.resize(at);
    else if (i % 3 == 1)
      bad[at] = char(bad[at] ^ (1 << random() % 8));
    else
      bad.insert(at, 1 + random() % 30, 'x');
    CHECK(is_refused(bad));
  }
}

TEST_CASE("false checkpoints with valid checksums are refused or give a picture") {
  const Room room;
  for (const Method method : {Method::kj92, Method::certified}) {
    RenderOptions o = options_for(method, method == Method::kj92 ? 14 : 24);
    o.width = 19;
    o.height = 9;
    o.indirect = method == Method::kj92 ? Indirect::automatic : Indirect::none;
    const File file;
    broken_off(room, o, file, false, 0.6, 1e9);
    Checkpoint good(file.path, room.key(o), {}, 1, {});
    good.read();
    const auto preparation =
        prepare(room.scene, method, o.kj92, o.indirect, std::nullopt, 2, {}, never_stopped);
    o.preparation = preparation.get();
    std::mt19937 random(2);
    int refused = 0;
    for (int i = 0; i < 40; ++i) {
      std::vector<std::vector<uint8_t>> chunks;
      for (const auto& c : good.chunks()) chunks.emplace_back(c.begin(), c.end());
      auto& chunk = chunks[random() % chunks.size()];
      const size_t at = random() % std::min<size_t>(chunk.size(), i % 2 == 0 ? 16 : 4096);
      switch (i % 4) {
        case 0:
          chunk[at] = uint8_t(random());
          break;
        case 1:
          chunk.resize(at + 1);
          break;
        case 2:
          chunks.push_back(chunk);  // the same tile twice
          break;
        default:
          for (size_t k = at; k < std::min(at + 8, chunk.size()); ++k) chunk[k] = 0xff;
      }
      const std::string path = file.path + "-lying";
      Checkpoint(path, room.key(o), {}, 1, {}).write([&](const Checkpoint::Add& add) {
        for (const auto& c : chunks) add(c);
      });
      Checkpoint read(path, room.key(o), {}, 1e9, {});
      read.read();
      RenderOptions again = o;
      again.checkpoint = &read;
      try {
        const RenderResult r = render_now(room.scene, room.camera, again);
        CHECK(r.layers[0].image.width == 19);
      } catch (const InputError& e) {
        ++refused;
        CHECK(e.reason() == "checkpoint has invalid values");
      }
      std::remove(path.c_str());
    }
    CHECK(refused > 12);
    CHECK(refused < 40);
  }
}

TEST_CASE("a checkpoint that cannot be written causes one warning, and rendering continues") {
  const Room room;
  RenderOptions o = options_for(Method::fixed, 6);
  std::vector<std::string> told;
  Checkpoint checkpoint("/nowhere/at/all.chk", room.key(o), {}, 0,
                        [&](const std::string& what) { told.push_back(what); });
  o.checkpoint = &checkpoint;
  const RenderResult r = render_now(room.scene, room.camera, o);
  CHECK(r.is_complete);
  REQUIRE(told.size() == 1);
  CHECK(told[0].find("cannot write /nowhere/at/all.chk") != std::string::npos);
  CHECK(checkpoint.failure() == told[0]);
  o.checkpoint = nullptr;
  CHECK(is_identical(r.layers, render_now(room.scene, room.camera, o).layers));
}

}  // namespace test_checkpoint
