// Light of one point of a rectangle at many receivers, vectorized over receivers. Resampled direct
// light uses it to choose between lights (transport/resampled_direct.h). light_sample.h computes
// the light that arrives.
#pragma once

#include <cstddef>

#include "light/light_primitive.h"

namespace troffer {

// n surface points as plain arrays: positions, unit shading normals, and unit geometric normals.
struct SurfaceArrays {
  size_t n = 0;
  const float *x = nullptr, *y = nullptr, *z = nullptr;
  const float *shading_x = nullptr, *shading_y = nullptr, *shading_z = nullptr;
  const float *normal_x = nullptr, *normal_y = nullptr, *normal_z = nullptr;
};

// Evaluates, up to rounding, the point of rectangle p that sample() (light_sample.h) returns for
// receiver i and (u[i], v[i]).
//   cosine[i]: with the shading normal; 0 if the point is on opposite sides of the two normals
//   inverse_pdf[i]: sr; 0 if p does not face the receiver; -1 if single precision cannot tell,
//   which happens only near p's plane
void points_of_rectangle(const LightPrimitive& p, const SurfaceArrays& receivers, const float* u,
                         const float* v, float* cosine, float* inverse_pdf);

}  // namespace troffer
