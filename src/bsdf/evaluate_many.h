// A Bsdf towards many directions at a stroke, several to a vector register.
#pragma once

#include <cstddef>

#include "bsdf/bsdf.h"

namespace troffer {

// Directions wi, unit and local as in bsdf.h, coordinate by coordinate, and what comes out there.
struct BsdfLanes {
  const float *x, *y, *z;
  float *r, *g, *b;  // f |cos wi|
  float* pdf;
};

// evaluate_with_pdf() for n directions, but for rounding; 0 where z <= 0. Those that transmit go
// one by one.
void evaluate_many(const Bsdf& bsdf, const Vec3& wo, size_t n, const BsdfLanes& lanes);

}  // namespace troffer
