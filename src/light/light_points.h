// Points on one piece of a light for one receiver, as plain arrays: light_sample.h for those who
// ask for many from one place, with what does not change from point to point done once.
#pragma once

#include <cstddef>
#include <vector>

#include "light/light_primitive.h"

namespace troffer {

// Plain arrays of one length.
struct LightPoints {
  std::vector<float> x, y, z;      // from the receiver to the point, metres
  std::vector<float> nx, ny, nz;   // unit normal at the point, on the side towards the receiver
  std::vector<float> inverse_pdf;  // sr; 0: no point faces the receiver
  size_t size() const { return x.size(); }
  void resize(size_t n);
};

// The points that sample() of light_sample.h chooses of `p` for the receiver from (u[i], v[i]), but
// for the last bits. False where nothing of it faces the receiver.
bool sample_points(const LightPrimitive& p, const Vec3& receiver, size_t n, const float* u,
                   const float* v, LightPoints& out);

// One of them: out's entry i.
void sample_point(const LightPrimitive& p, const Vec3& receiver, float u, float v, size_t i,
                  LightPoints& out);

// Nothing of the piece lies above the horizon of a receiver of unit normal n.
bool is_below_horizon(const LightPrimitive& p, const Vec3& receiver, const Vec3& n);

}  // namespace troffer
