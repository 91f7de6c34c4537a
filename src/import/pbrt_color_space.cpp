#include "import/pbrt_color_space.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include "base/transform.h"

namespace troffer {

namespace {

struct Chromaticity {
  double x, y;
};

struct Primaries {
  std::string_view name;
  std::array<Chromaticity, 3> colors;
  Chromaticity white;
};

constexpr Chromaticity d65{0.3127, 0.3290};

constexpr std::array<Primaries, 4> all_primaries{{
    // [2], as PbrtColorSpace counts them
    {"srgb", {{{0.64, 0.33}, {0.30, 0.60}, {0.15, 0.06}}}, d65},
    {"rec2020", {{{0.708, 0.292}, {0.170, 0.797}, {0.131, 0.046}}}, d65},
    {"dci-p3", {{{0.680, 0.320}, {0.265, 0.690}, {0.150, 0.060}}}, d65},
    {"aces2065-1", {{{0.7347, 0.2653}, {0, 1}, {0.0001, -0.077}}}, {0.32168, 0.33767}},
}};

const Primaries& primaries_of(PbrtColorSpace space) {
  return all_primaries[size_t(space)];
}

// XYZ of luminance 1.
Vec3d xyz_of(const Chromaticity& c) {
  return {c.x / c.y, 1, (1 - c.x - c.y) / c.y};
}

// The primaries add up to a white of luminance 1.
Affine xyz_from(const Primaries& p) {
  Affine m;
  for (size_t i = 0; i < 3; ++i) {
    const auto [x, y] = p.colors[i];
    m.columns[i] = {x, y, 1 - x - y};
  }
  const Vec3d amounts = inverse(m).vector(xyz_of(p.white));
  for (size_t i = 0; i < 3; ++i) m.columns[i] = m.columns[i] * amounts[i];
  return m;
}

// XYZ of what looks under one white as the argument does under the other [3].
Affine adaptation(const Chromaticity& from, const Chromaticity& to) {
  Affine cones;
  cones.columns = {Vec3d{0.8951, -0.7502, 0.0389}, Vec3d{0.2664, 1.7135, -0.0685},
                   Vec3d{-0.1614, 0.0367, 1.0296}};
  const Vec3d before = cones.vector(xyz_of(from)), after = cones.vector(xyz_of(to));
  return inverse(cones) *
         Affine::scale({after.x / before.x, after.y / before.y, after.z / before.z}) * cones;
}

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
  const Primaries& from = primaries_of(space);
  const Primaries& srgb = primaries_of(PbrtColorSpace::srgb);
  const Affine seen = shines ? Affine() : adaptation(from.white, srgb.white);
  const Affine matrix = inverse(xyz_from(srgb)) * seen * xyz_from(from);
  for (size_t i = 0; i + 2 < param.numbers.size(); i += 3) {
    const Vec3d c = matrix.vector({param.numbers[i], param.numbers[i + 1], param.numbers[i + 2]});
    // A white stays one to the last digit, where it would be a rounding above 1 and be clamped.
    for (size_t k = 0; k < 3; ++k)
      param.numbers[i + k] = std::abs(c[k] - 1) < 1e-7 ? 1 : std::abs(c[k]) < 1e-7 ? 0 : c[k];
  }
}

}  // namespace troffer
