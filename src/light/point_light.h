// A point that sends the same radiant intensity I in all directions, or one that a web says.
#pragma once

#include "base/units.h"
#include "light/no_surface.h"
#include "light/web.h"

namespace troffer {

struct PointLight : NoSurface {
  static void bound(const Scene& scene, const Light& e, const Box& /*bounds*/, LightPrimitive& p) {
    set_point(p, e.position);
    if (e.web == no_web) {
      p.mean_radiance = e.radiance;
      p.power = p.tree_power = 4 * pi_f * luminance(e.radiance);
      return;
    }
    const LightWeb& web = scene.webs[size_t(e.web)];
    const auto total = float(flux(web));
    p.mean_radiance = e.radiance * (total / (4 * pi_f));
    p.power = total * luminance(e.radiance);
    p.tree_power = 4 * pi_f * largest_intensity(web) * luminance(e.radiance);
  }
  // Irradiance I / r² on a surface that faces it.
  static bool sample(const Scene& scene, const LightPrimitive& p, const Vec3& x, const Vec2& /*u*/,
                     LightSample& out) {
    const Light& e = scene.lights[p.light];
    if (e.web == no_web) return sample_point(e, x, e.radiance, out);
    const Vec3 from_light = x - e.position;
    const float distance = length(from_light);
    if (!(distance > 0)) return false;
    const Vec3 w = in_own_axes(e, from_light * (1 / distance));
    return sample_point(e, x, e.radiance * intensity(scene.webs[size_t(e.web)], w), out);
  }
};

}  // namespace troffer
