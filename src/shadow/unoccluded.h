// Exact unoccluded irradiance of a flat polygon at many receivers at a stroke.
// References: [1] Lambert's formula, as in light/irradiance.h.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "base/vec.h"

namespace troffer {

// Positions and unit normals of receivers, coordinate by coordinate; horizons as in the function
// below, empty where they are the normals.
struct ReceiverArrays {
  std::vector<double> position[3], normal[3];
  std::vector<Vec3> horizons;
  size_t size = 0;

  void assign(size_t n);  // room for n, without horizons
  void set(size_t i, const Vec3& p, const Vec3& n);
  Vec3d position_at(size_t i) const { return {position[0][i], position[1][i], position[2][i]}; }
  Vec3d normal_at(size_t i) const { return {normal[0][i], normal[1][i], normal[2][i]}; }
};

// out[i] = projected solid angle (steradians) of the convex polygon `outline` at receiver i,
// between 0 and pi: of the part above the horizon of its normal and, where there are horizons,
// above that of horizons[i] too. 0 behind the polygon's plane, whose unit normal is
// `plane_normal`, on either side of the polygon, and in it: up to 2^-21 of the largest coordinates
// above it, which is where rounding may put what lies on the source itself. Relative error under
// 1e-4 wherever the value is over 3e-10, mostly under 1e-6. At most 16 corners.
void unoccluded_irradiance(std::span<const Vec3d> outline, const Vec3d& plane_normal,
                           const ReceiverArrays& receivers, float* out);

}  // namespace troffer
