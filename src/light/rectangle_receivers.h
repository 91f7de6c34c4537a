// One rectangle and many receivers: what one point of it would bring to each, several receivers to
// a vector register. For choosing between lights; what arrives is for light_sample.h to say.
#pragma once

#include <cstddef>

#include "light/light_primitive.h"

namespace troffer {

// n surface points, as plain arrays: where they are, and their unit shading normals and geometric
// normals.
struct SurfaceArrays {
  size_t n = 0;
  const float *x = nullptr, *y = nullptr, *z = nullptr;
  const float *shading_x = nullptr, *shading_y = nullptr, *shading_z = nullptr;
  const float *normal_x = nullptr, *normal_y = nullptr, *normal_z = nullptr;
};

// For the point of rectangle p that sample() (light_sample.h) chooses for receiver i by (u[i],
// v[i]), up to rounding: cosine[i], of its direction and the shading normal, 0 where the two
// normals disagree on its side; inverse_pdf[i], sr, 0 where nothing of p faces the receiver, and -1
// where single precision does not tell: on what p's plane nearly holds.
void points_of_rectangle(const LightPrimitive& p, const SurfaceArrays& receivers, const float* u,
                         const float* v, float* cosine, float* inverse_pdf);

}  // namespace troffer
