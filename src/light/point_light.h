// A point that sends the same radiant intensity I in all directions.
#pragma once

#include "base/units.h"
#include "light/no_surface.h"

namespace troffer {

struct PointLight : NoSurface {
  static void bound(const Light& e, const Box& /*scene*/, LightPrimitive& p) {
    set_point(p, e.position);
    p.mean_radiance = e.radiance;
    p.power = p.tree_power = 4 * pi_f * luminance(e.radiance);
  }
  // Irradiance I / r² on a surface that faces it.
  static bool sample(const Scene& scene, const LightPrimitive& p, const Vec3& x, const Vec2& /*u*/,
                     LightSample& out) {
    const Light& e = scene.lights[p.light];
    return sample_point(e.position, x, e.radiance, out);
  }
};

}  // namespace troffer
