// Surfaces that transmit light diffusely, such as curtains. A hit on one gives two vertices, one on
// either side, each with its part of the BSDF. WaveIntegrator and gather rays follow both; path
// tracing chooses one.
#pragma once

#include "base/random.h"
#include "base/streams.h"
#include "transport/purposes.h"
#include "transport/vertex.h"
#include "transport/walk.h"

namespace troffer {

inline bool has_two_sides(const Bsdf& bsdf) {
  return !bsdf.through.is_black();
}

// Returns v as seen from the far side, by a viewer in the mirrored position.
inline Vertex far_side(const Vertex& v) {
  Vertex far = v;
  far.geometric_normal = v.geometric_normal * -1.0f;
  far.frame = Frame(v.frame.normal * -1.0f);
  far.is_front = !v.is_front;
  return far;
}

// Returns a random stream for the far side that is independent of this side's.
inline uint64_t far_stream(uint64_t stream) {
  return hash_of(stream, stream::far_side);
}

// Moves the far side's part out of `bsdf` and returns it. Sets `far` and `walk`'s stream to those
// of the far side.
inline Bsdf take_far_side(const Vertex& v, Bsdf& bsdf, Walk& walk, Vertex& far) {
  far = far_side(v);
  walk.stream = far_stream(walk.stream);
  const Bsdf part = through_part(bsdf);
  bsdf.through = Rgb{0};
  return part;
}

// Chooses one of the two sides with probability proportional to its albedo.
inline void choose_side(Walk& walk, Vertex& v, Bsdf& bsdf) {
  const Bsdf part = through_part(bsdf);
  bsdf.through = Rgb{0};
  const float near = luminance(albedo(bsdf, v.wo.z)), far = luminance(albedo(part, v.wo.z));
  const float share = far / (near + far);
  if (!(side_number(walk) < share)) {
    if (share > 0) walk.throughput *= 1 / (1 - share);
    return;
  }
  walk.throughput *= 1 / share;
  v = far_side(v);
  bsdf = part;
}

}  // namespace troffer
