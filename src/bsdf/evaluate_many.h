// Evaluates a Bsdf for many directions at once with vector instructions. The certified light
// integrals use it, where one receiver has many source samples. Conventions are those of bsdf.h.
#pragma once

#include <cstddef>

#include "bsdf/bsdf.h"

namespace troffer {

// Unit directions wi in the frame of bsdf.h, one array per coordinate, and the results for them.
struct BsdfLanes {
  const float *x, *y, *z;
  float *r, *g, *b;  // f |cos wi|
  float* pdf;
};

// Computes evaluate_with_pdf() for n directions, up to rounding; 0 where z <= 0. Bsdfs with
// transmission, grain, covers, films or unbalanced facets are evaluated one by one.
void evaluate_many(const Bsdf& bsdf, const Vec3& wo, size_t n, const BsdfLanes& lanes);

}  // namespace troffer
