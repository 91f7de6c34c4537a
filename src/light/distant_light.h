// Parallel light from infinity, such as a sun without size. One of the light kinds behind light.h.
#pragma once

#include "base/units.h"
#include "light/no_surface.h"

namespace troffer {

struct DistantLight : NoSurface {
  static void bound(const Scene&, const Light& e, const Box& bounds, LightPrimitive& p) {
    p.shape = PrimitiveShape::infinite;
    p.mean_radiance = e.radiance;
    // Power that enters a sphere around the scene.
    p.power = p.tree_power = pi_f * sqr(0.5f * bounds.diagonal()) * luminance(e.radiance);
    p.cone_axis = e.direction;
    p.cos_cone = 1;
  }
  static bool sample(const Scene& scene, const LightPrimitive& p, const Vec3& /*x*/,
                     const Vec2& /*u*/, LightSample& out) {
    const Light& e = scene.lights[p.light];
    sample_infinity(-e.direction, e.radiance, 1, out);
    out.is_delta = true;
    return true;
  }
};

}  // namespace troffer
