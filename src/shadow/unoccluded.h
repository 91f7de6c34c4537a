// Exact unoccluded irradiance of a flat polygon at many receivers. shadow_cluster.h uses it.
// References: [1] Lambert's formula, as in light/irradiance.h.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "base/vec.h"

namespace troffer {

// Positions and unit normals of receivers as separate coordinates. horizons: unit normals of their
// horizons; empty if they equal the normals.
struct ReceiverArrays {
  std::vector<double> position[3], normal[3];
  std::vector<Vec3> horizons;
  size_t size = 0;

  void assign(size_t n);  // makes room for n receivers without horizons
  void set(size_t i, const Vec3& p, const Vec3& n);
  Vec3d position_at(size_t i) const { return {position[0][i], position[1][i], position[2][i]}; }
  Vec3d normal_at(size_t i) const { return {normal[0][i], normal[1][i], normal[2][i]}; }
};

// Sets out[i] to the projected solid angle of the convex polygon `outline` at receiver i, in sr,
// from 0 to pi. Only the part above the horizon of the normal, and of horizons[i] if given, counts.
// The result is 0 behind and in the polygon's plane, whose unit normal is `plane_normal`: up to
// 2^-21 of the largest coordinate above it, where rounding may put points of the source itself.
// Relative error below 1e-4 for values over 3e-10, mostly below 1e-6. At most 16 corners.
void unoccluded_irradiance(std::span<const Vec3d> outline, const Vec3d& plane_normal,
                           const ReceiverArrays& receivers, float* out);

}  // namespace troffer
