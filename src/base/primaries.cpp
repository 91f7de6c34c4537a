#include "base/primaries.h"

#include <cmath>

namespace troffer {

namespace {

// XYZ of a chromaticity with luminance 1.
Vec3d xyz_of(const Chromaticity& c) {
  return {c.x / c.y, 1, (1 - c.x - c.y) / c.y};
}

// Matrix from the primaries to XYZ, where (1, 1, 1) is a white of luminance 1.
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

// Chromatic adaptation of XYZ from one white to another [2].
Affine adaptation(const Chromaticity& from, const Chromaticity& to) {
  Affine cones;
  cones.columns = {Vec3d{0.8951, -0.7502, 0.0389}, Vec3d{0.2664, 1.7135, -0.0685},
                   Vec3d{-0.1614, 0.0367, 1.0296}};
  const Vec3d before = cones.vector(xyz_of(from)), after = cones.vector(xyz_of(to));
  return inverse(cones) *
         Affine::scale({after.x / before.x, after.y / before.y, after.z / before.z}) * cones;
}

}  // namespace

Affine srgb_from(const Primaries& primaries, bool keeps_white) {
  const Affine seen = keeps_white ? adaptation(primaries.white, srgb_primaries.white) : Affine();
  return inverse(xyz_from(srgb_primaries)) * seen * xyz_from(primaries);
}

bool are_srgb(const Primaries& primaries) {
  constexpr double digits = 1e-3;
  const auto is_same = [](const Chromaticity& a, const Chromaticity& b) {
    return std::abs(a.x - b.x) < digits && std::abs(a.y - b.y) < digits;
  };
  for (size_t i = 0; i < 3; ++i)
    if (!is_same(primaries.colors[i], srgb_primaries.colors[i])) return false;
  return is_same(primaries.white, srgb_primaries.white);
}

}  // namespace troffer
