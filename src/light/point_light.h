// A point light: its radiant intensity is uniform, or given by a photometric web, an image of all
// directions, or a projected image. One of the light kinds behind light.h.
#pragma once

#include <algorithm>

#include "base/units.h"
#include "light/environment_image.h"
#include "light/no_surface.h"
#include "light/web.h"
#include "scene/projected_image.h"

namespace troffer {

struct PointEmitter : NoSurface {
  static void bound(const Scene& scene, const Light& e, const Box& /*bounds*/, LightPrimitive& p) {
    set_point(p, e.position);
    if (e.environment != no_environment || e.texture != no_texture) {
      bound_image(scene, e, p);
      return;
    }
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
  // Samples the light's irradiance I / r² on a surface that faces it.
  static bool sample(const Scene& scene, const LightPrimitive& p, const Vec3& x, const Vec2& /*u*/,
                     LightSample& out) {
    const Light& e = scene.lights[p.light];
    const bool is_even =
        e.web == no_web && e.environment == no_environment && e.texture == no_texture;
    if (is_even) return sample_point(e, x, e.radiance, out);
    const Vec3 from_light = x - e.position;
    const float distance = length(from_light);
    if (!(distance > 0)) return false;
    const Vec3 w = in_own_axes(e, from_light * (1 / distance));
    if (e.texture != no_texture)
      return sample_point(e, x, e.radiance * projected(scene, e, w), out);
    if (e.environment != no_environment)
      return sample_point(
          e, x, e.radiance * radiance_towards(scene.environments[size_t(e.environment)], w), out);
    return sample_point(e, x, e.radiance * intensity(scene.webs[size_t(e.web)], w), out);
  }

 private:
  // Sets the bounds of a light with an image: mean radiance of the image, and for light trees the
  // power at its brightest texel everywhere.
  static void bound_image(const Scene& scene, const Light& e, LightPrimitive& p) {
    constexpr float sphere = 4 * pi_f;
    float largest = 1;
    if (e.texture != no_texture) {
      p.mean_radiance = e.radiance * projected_flux(scene, e) * (1 / sphere);
      if (e.has_uniform_plane) largest = inverse_cube_of_cosine(e, {1, 1, 1});
    } else {
      const EnvironmentMap& map = scene.environments[size_t(e.environment)];
      p.mean_radiance = e.radiance * (float(direction_table(map).integral()) / sphere);
      largest = 0;
      for (const Rgb& texel : map.texels) largest = std::max(largest, luminance(texel));
    }
    p.power = sphere * luminance(p.mean_radiance);
    p.tree_power = sphere * luminance(e.radiance) * largest;
  }
};

}  // namespace troffer
