// A point that shines within a cone, fading between two angles from its axis.
// References: [1] Pharr, Jakob & Humphreys, "Physically Based Rendering", 4th ed., §12.2.1.
//   [2] Khronos, glTF extension KHR_lights_punctual ("Inner and Outer Cone Angles").
#pragma once

#include <algorithm>
#include <cmath>

#include "base/units.h"
#include "light/no_surface.h"

namespace troffer {

struct SpotLight : NoSurface {
  // Radiant intensity in a direction at this cosine from the axis, as a share of the largest: a
  // smooth step in the cosine [1], or its square [2].
  static float share(const Light& e, float cosine) {
    if (cosine >= e.cos_inner) return 1;
    if (cosine <= e.cos_outer) return 0;
    const float t = (cosine - e.cos_outer) / (e.cos_inner - e.cos_outer);
    return e.falloff == SpotFalloff::square ? t * t : t * t * (3 - 2 * t);
  }

  static void bound(const Scene&, const Light& e, const Box&, LightPrimitive& p) {
    set_point(p, e.position);
    p.mean_radiance = e.radiance;
    // Between the cosines the smooth step has half of the light, since it is symmetric, and the
    // square a third.
    const float between = e.falloff == SpotFalloff::square ? 1.0f / 3 : 0.5f;
    const float solid_angle =
        2 * pi_f * ((1 - e.cos_inner) + between * (e.cos_inner - e.cos_outer));
    p.power = solid_angle * luminance(e.radiance);
    p.tree_power = 4 * pi_f * luminance(e.radiance);
    // Normals whose hemispheres hold the beam.
    p.cone_axis = e.direction;
    p.cos_cone = e.cos_outer >= 0 ? 1 : std::sqrt(std::max(0.0f, 1 - sqr(e.cos_outer)));
  }
  static bool sample(const Scene& scene, const LightPrimitive& p, const Vec3& x, const Vec2& /*u*/,
                     LightSample& out) {
    const Light& e = scene.lights[p.light];
    const Vec3 from_light = x - e.position;
    const float distance = length(from_light);
    if (!(distance > 0)) return false;
    return sample_point(e, x, e.radiance * share(e, dot(from_light, e.direction) / distance), out);
  }
};

}  // namespace troffer
