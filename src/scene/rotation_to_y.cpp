#include "scene/rotation_to_y.h"

#include <cmath>

namespace troffer {

// References: [1] Möller & Hughes, "Efficiently Building a Matrix to Rotate One Vector to Another",
//   JGT 4(4), 1999.
std::array<Vec3d, 3> rotation_to_y(const Vec3& up) {
  const Vec3d from = normalize(Vec3d(up)), to{0, 1, 0};
  const double c = dot(from, to);
  if (!(c > -1 + 1e-9)) return {Vec3d{1, 0, 0}, Vec3d{0, -1, 0}, Vec3d{0, 0, -1}};
  // [1] Eq. 3: c I + [v]x + v vᵀ / (1 + c).
  const Vec3d v = cross(from, to);
  std::array<Vec3d, 3> images;
  const std::array<Vec3d, 3> axes{Vec3d{1, 0, 0}, Vec3d{0, 1, 0}, Vec3d{0, 0, 1}};
  for (size_t k = 0; k < 3; ++k)
    images[k] = axes[k] * c + cross(v, axes[k]) + v * (dot(v, axes[k]) / (1 + c));
  return images;
}

std::string describe_turn(const std::array<Vec3d, 3>& images) {
  std::string rows;
  for (size_t row = 0; row < 3; ++row) {
    std::string term;
    for (size_t k = 0; k < 3; ++k) {
      const double v = images[k][row];
      if (std::abs(v) < 1e-9) continue;
      if (!term.empty() || std::abs(std::abs(v) - 1) > 1e-9) return {};
      term = std::string(v < 0 ? "-" : "") + "xyz"[k];
    }
    rows += (row > 0 ? ", " : "") + term;
  }
  return "(x, y, z) becomes (" + rows + ")";
}

}  // namespace troffer
