// Feeds a rendering a radiosity solution, or cells, that libFuzzer makes: a file of this very scene
// with a right checksum and arbitrary contents. It must be refused with InputError, or give some
// light. Bytes: pieces, each after its place in the file (two bytes) and its size (one).
#include <algorithm>
#include <cstdint>
#include <cstring>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "base/error.h"
#include "base/own_file.h"
#include "render/kept_cells.h"
#include "render/measure.h"
#include "render/radiosity.h"
#include "support/scenes.h"

namespace {

using namespace troffer;

constexpr bool is_radiosity = std::string_view(FUZZ_ENDING) == "trad";
// The checksum is at the end of the header.
constexpr size_t header_size = is_radiosity ? 208 : 80;
const StopFlag never = false;

Scene two_walls() {
  Scene s;
  const uint32_t grey = test::add_diffuse(s, Rgb{0.5f});
  test::add_quad(s, grey, {Vec3{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}});
  test::add_quad(s, grey, {Vec3{0, 0, 0}, {0, 2, 0}, {0, 2, 2}, {0, 0, 2}});
  const uint32_t lamp =
      test::add_quad(s, grey, {Vec3{0.5f, 0.5f, 2}, {0.5f, 1, 2}, {1, 1, 2}, {1, 0.5f, 2}});
  test::make_light(s, lamp, Rgb{10});
  return s;
}

RadiosityOptions coarse() {
  RadiosityOptions o;
  o.meshing.element_size = o.meshing.patch_size = 1;
  o.meshing.max_elements = o.meshing.max_sheets = 100;
  o.unshot_fraction = 0.1f;
  return o;
}

struct Target {
  const PreparedScene scene{two_walls()};
  const std::vector<uint8_t> good = make();

  std::vector<uint8_t> make() const {
    if (is_radiosity)
      return save_radiosity(scene, preprocess(scene, coarse(), 1, {}, never).solution);
    return save_kept_cells(scene, cells_of_surfaces(scene, 0.5, 1, 1, {}, never));
  }

  std::vector<uint8_t> changed(std::span<const uint8_t> pieces) const {
    std::vector<uint8_t> file = good;
    while (pieces.size() > 3) {
      const size_t at = size_t(pieces[0]) | size_t(pieces[1]) << 8;
      const size_t size = std::min(size_t(pieces[2]), pieces.size() - 3);
      if (at + size > file.size()) file.resize(at + size);
      std::copy_n(pieces.begin() + 3, size, file.begin() + std::ptrdiff_t(at));
      pieces = pieces.subspan(3 + size);
    }
    std::span<uint8_t> sum = std::span(file).subspan(header_size - 8, 8);
    std::fill(sum.begin(), sum.end(), uint8_t(0));
    const std::span<const uint8_t> all = file;
    const uint64_t right = hash_of_parts(all.first(header_size), all.subspan(header_size));
    std::memcpy(sum.data(), &right, sizeof(right));
    return file;
  }

  // Measures a point with the solution or the cells.
  void use(std::span<const uint8_t> file) const {
    MeasureOptions o;
    o.error = 0.5;
    o.spp = 1;
    o.threads = 1;
    std::unique_ptr<Preparation> preparation;
    std::optional<CellStore> cells;
    if (is_radiosity) {
      o.method = Method::kj92;
      o.indirect = Indirect::radiosity;
      preparation = prepare(scene, o.method, o.kj92, o.indirect,
                            load_radiosity(scene, file, "input", nullptr, 1), 1, {}, never);
      o.preparation = preparation.get();
    } else {
      o.indirect = Indirect::cells;
      cells = load_kept_cells(scene, file, "input");
      o.cells = &*cells;
    }
    measure(scene, {{{1, 1, 0}, {0, 0, 1}}}, o, {}, never);
  }
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  static const Target target;
  try {
    target.use(target.changed({data, size}));
  } catch (const InputError&) {
    return 0;
  }
  return 0;
}
