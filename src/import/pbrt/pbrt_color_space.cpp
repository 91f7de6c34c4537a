#include "import/pbrt/pbrt_color_space.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include "base/primaries.h"

namespace troffer {

namespace {

struct NamedPrimaries {
  std::string_view name;
  Primaries primaries;
};

constexpr Chromaticity d65 = srgb_primaries.white;

constexpr std::array<NamedPrimaries, 4> all_primaries{{
    // Indexed by PbrtColorSpace; values from [2].
    {"srgb", srgb_primaries},
    {"rec2020", {{{{0.708, 0.292}, {0.170, 0.797}, {0.131, 0.046}}}, d65}},
    {"dci-p3", {{{{0.680, 0.320}, {0.265, 0.690}, {0.150, 0.060}}}, d65}},
    {"aces2065-1", {{{{0.7347, 0.2653}, {0, 1}, {0.0001, -0.077}}}, {0.32168, 0.33767}}},
}};

}  // namespace

void read_pbrt_color_space(const std::string& name, const PbrtPlace& place, PbrtColorSpace& space,
                           WarningLog& warnings) {
  std::string lower = name;
  std::transform(lower.begin(), lower.end(), lower.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? char(c + 'a' - 'A') : c; });
  for (size_t i = 0; i < all_primaries.size(); ++i)
    if (all_primaries[i].name == lower) {
      space = PbrtColorSpace(i);
      return;
    }
  warnings.add(at_place(place, "ColorSpace \"" + name + "\" is unknown: ignored"));
}

void to_srgb(PbrtParam& param, PbrtColorSpace space, bool shines) {
  if (space == PbrtColorSpace::srgb || param.type != PbrtType::rgb) return;
  const Affine matrix = srgb_from(all_primaries[size_t(space)].primaries, !shines);
  for (size_t i = 0; i + 2 < param.numbers.size(); i += 3) {
    const Vec3d c = matrix.vector({param.numbers[i], param.numbers[i + 1], param.numbers[i + 2]});
    // Rounds values next to 0 and 1, so that white is not clamped for a rounding error above 1.
    for (size_t k = 0; k < 3; ++k)
      param.numbers[i + k] = std::abs(c[k] - 1) < 1e-7 ? 1 : std::abs(c[k]) < 1e-7 ? 0 : c[k];
  }
}

}  // namespace troffer
