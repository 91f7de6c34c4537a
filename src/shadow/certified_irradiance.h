// Exact unoccluded irradiance of a flat polygon at many receivers at a stroke.
// References: [1] Lambert's formula, as in emitter/irradiance.h.
#pragma once

#include <cstddef>
#include <span>

#include "base/vec.h"

namespace troffer {

// out[i] = projected solid angle (steradians) of the convex polygon `outline` above the horizon of
// receiver i, between 0 and pi; 0 in or behind its plane, whose unit normal is `normal` (of either
// side of the polygon: receivers behind it get 0). Relative error under 1e-8 for receivers between
// 1e-4 and 1e3 source sizes. At most 8 corners.
void unoccluded_irradiance(std::span<const Vec3d> outline, const Vec3d& normal, size_t n,
                           const Vec3* positions, const Vec3* normals, float* out);

}  // namespace troffer
