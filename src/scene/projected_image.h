// Point and spot lights that project a texture like a slide (Light::texture). The light's z axis is
// the beam's centre. Its x and y axes have lengths of one over half the picture's width and height
// at distance 1; row 0 is at -y. Used by light/ and by importers.
#pragma once

#include <cmath>

#include "scene/scene.h"

namespace troffer {

// 1 / cos³ of the angle between the axis and w, given in the light's axes.
inline float inverse_cube_of_cosine(const Light& e, const Vec3& w) {
  const Vec3 true_length{w.x / length(e.axes[0]), w.y / length(e.axes[1]), w.z};
  const float cosine = w.z / length(true_length);
  return 1 / (cosine * cosine * cosine);
}

// Factor on the intensity in the direction w (components along the light's axes, of any length);
// black outside the picture.
inline Rgb projected(const Scene& scene, const Light& e, const Vec3& w) {
  if (!(w.z > 0)) return Rgb{0};
  const Vec2 uv{0.5f * (1 + w.x / w.z), 0.5f * (1 + w.y / w.z)};
  if (!(uv.x >= 0 && uv.x <= 1 && uv.y >= 0 && uv.y <= 1)) return Rgb{0};
  const Rgb value = evaluate(scene.textures, uint32_t(e.texture), uv).rgb;
  return e.has_uniform_plane ? value * inverse_cube_of_cosine(e, w) : value;
}

// Integral of that factor over all directions, by the midpoint rule with 256 × 256 samples.
Rgb projected_flux(const Scene& scene, const Light& e);

}  // namespace troffer
