// A point light that shines within a cone and fades between two angles from its axis. One of the
// light kinds behind light.h.
// References: [1] Pharr, Jakob & Humphreys, "Physically Based Rendering", 4th ed., §12.2.1.
//   [2] Khronos, glTF extension KHR_lights_punctual ("Inner and Outer Cone Angles").
//   [3] W. Jakob et al., "Mitsuba 3 documentation: Emitters" (spot).
#pragma once

#include <algorithm>
#include <cmath>

#include "base/units.h"
#include "light/no_surface.h"
#include "scene/projected_image.h"

namespace troffer {

struct SpotLight : NoSurface {
  // Share of the largest radiant intensity in a direction with this cosine from the axis: a smooth
  // step in the cosine [1], the square of a ramp in the cosine [2], or linear in the angle [3].
  static float share(const Light& e, float cosine) {
    if (cosine >= e.cos_inner) return 1;
    if (cosine <= e.cos_outer) return 0;
    if (e.falloff == SpotFalloff::linear) {
      const float outer = std::acos(e.cos_outer), inner = std::acos(e.cos_inner);
      return std::clamp((outer - std::acos(cosine)) / (outer - inner), 0.0f, 1.0f);
    }
    const float t = (cosine - e.cos_outer) / (e.cos_inner - e.cos_outer);
    return e.falloff == SpotFalloff::square ? t * t : t * t * (3 - 2 * t);
  }

  static void bound(const Scene&, const Light& e, const Box&, LightPrimitive& p) {
    set_point(p, e.position);
    p.mean_radiance = e.radiance;
    p.power = effective_solid_angle(e) * luminance(e.radiance);
    p.tree_power = 4 * pi_f * luminance(e.radiance);
    // A cone of normals whose hemispheres contain the beam.
    p.cone_axis = e.direction;
    p.cos_cone = e.cos_outer >= 0 ? 1 : std::sqrt(std::max(0.0f, 1 - sqr(e.cos_outer)));
  }
  // Integral of share() over all directions, sr. Between the two cosines, the smooth step has a
  // mean of 1/2, by symmetry, and the square 1/3. The linear falloff is integrated by parts: 1 -
  // (sin outer - sin inner) / (outer - inner) for the whole cone, in units of 2 pi.
  static float effective_solid_angle(const Light& e) {
    if (e.falloff == SpotFalloff::linear) {
      const float outer = std::acos(e.cos_outer), inner = std::acos(e.cos_inner);
      return 2 * pi_f * (1 - (std::sin(outer) - std::sin(inner)) / (outer - inner));
    }
    const float between = e.falloff == SpotFalloff::square ? 1.0f / 3 : 0.5f;
    return 2 * pi_f * ((1 - e.cos_inner) + between * (e.cos_inner - e.cos_outer));
  }
  static bool sample(const Scene& scene, const LightPrimitive& p, const Vec3& x, const Vec2& /*u*/,
                     LightSample& out) {
    const Light& e = scene.lights[p.light];
    const Vec3 from_light = x - e.position;
    const float distance = length(from_light);
    if (!(distance > 0)) return false;
    Rgb intensity = e.radiance * share(e, dot(from_light, e.direction) / distance);
    if (e.texture != no_texture && !intensity.is_black())
      intensity *= projected(scene, e, in_own_axes(e, from_light));
    return sample_point(e, x, intensity, out);
  }
};

}  // namespace troffer
