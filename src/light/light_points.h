// Many sample points on one piece of a light for one receiver, as plain arrays. The points are
// those of light_sample.h, but values common to all points are computed once. They serve callers
// that cast several rays per light (shadow/direct_rays.h, transport/source_sampler.h).
#pragma once

#include <cstddef>
#include <vector>

#include "light/light_primitive.h"

namespace troffer {

// Sample points as arrays of equal length.
struct LightPoints {
  std::vector<float> x, y, z;      // vector from the receiver, metres
  std::vector<float> nx, ny, nz;   // unit normal on the receiver's side
  std::vector<float> inverse_pdf;  // sr; 0: no point faces the receiver
  size_t size() const { return x.size(); }
  void resize(size_t n);
};

// Computes the points that sample() of light_sample.h returns for (u[i], v[i]), up to rounding.
// Returns false if no point of the piece faces the receiver.
bool sample_points(const LightPrimitive& p, const Vec3& receiver, size_t n, const float* u,
                   const float* v, LightPoints& out);

// Computes one such point as entry i of `out`.
void sample_point(const LightPrimitive& p, const Vec3& receiver, float u, float v, size_t i,
                  LightPoints& out);

// True if the whole piece lies below the horizon of a receiver with unit normal n.
bool is_below_horizon(const LightPrimitive& p, const Vec3& receiver, const Vec3& n);

}  // namespace troffer
