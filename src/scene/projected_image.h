// A point or spot that throws a texture like a slide: Light::texture. Its own z is the middle of
// the beam, and its own x and y are as long as one over half the picture's width and height at a
// distance of 1; row 0 is at -y.
#pragma once

#include <cmath>

#include "scene/scene.h"

namespace troffer {

// 1 / cos³ of the angle between the axis and w, which is along the light's axes.
inline float inverse_cube_of_cosine(const Light& e, const Vec3& w) {
  const Vec3 true_length{w.x / length(e.axes[0]), w.y / length(e.axes[1]), w.z};
  const float cosine = w.z / length(true_length);
  return 1 / (cosine * cosine * cosine);
}

// Factor on the intensity in the direction w (its components along the light's axes, of any
// length); black outside of the picture.
inline Rgb projected(const Scene& scene, const Light& e, const Vec3& w) {
  if (!(w.z > 0)) return Rgb{0};
  const Vec2 uv{0.5f * (1 + w.x / w.z), 0.5f * (1 + w.y / w.z)};
  if (!(uv.x >= 0 && uv.x <= 1 && uv.y >= 0 && uv.y <= 1)) return Rgb{0};
  const Rgb value = evaluate(scene.textures, uint32_t(e.texture), uv).rgb;
  return e.lights_plane_evenly ? value * inverse_cube_of_cosine(e, w) : value;
}

// Integral of that factor over all directions, by the middles of 256 × 256 parts.
Rgb projected_flux(const Scene& scene, const Light& e);

}  // namespace troffer
