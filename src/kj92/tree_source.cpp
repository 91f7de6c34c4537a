#include "kj92/tree_source.h"

#include <algorithm>
#include <cmath>

#include "light/irradiance.h"
#include "light/light_sample.h"
#include "radiosity/patch_surface.h"
#include "transport/connect.h"

namespace troffer {

TreeSource::TreeSource(const PreparedScene& scene, uint32_t light)
    : surface_(scene.scene, light), light_(int32_t(light)) {
  const Light& e = scene.scene.lights[light];
  const LightPrimitives::Range range = scene.primitives.of_light(light);
  radiance_ = e.radiance;
  is_two_sided_ = e.is_two_sided;
  is_black_ = range.first == range.last;
  is_delta_ = troffer::is_delta(e.kind);
  is_convex_ = range.last - range.first == 1 && has_surface(e.kind);
  is_constant_ = has_surface(e.kind) && e.texture < 0 && !e.is_alpha_masked && e.web == no_web;
  if (!is_black_ && (!has_surface(e.kind) || e.kind == LightKind::sphere))
    sampled_ = int32_t(range.first);
}

TreeSource::TreeSource(const PreparedScene&, const RadiositySolution& solution, uint32_t patch)
    : surface_(patch_surface(solution.mesh, patch)), radiance_(solution.shot_radiance[patch]) {
  const Sheet& sheet = solution.mesh.sheets[solution.mesh.patches[patch].sheet];
  is_convex_ = false;
  is_black_ = radiance_.is_black();
  round_centre_ = sheet.round_centre;
  round_radius_ = sheet.round_radius;
}

Rgb TreeSource::exact_irradiance(const PreparedScene& scene, const Vertex& v) const {
  return radiance_ * float(irradiance(scene.primitives, uint32_t(light_), Vec3d(v.surface.position),
                                      Vec3d(v.frame.normal)));
}

bool TreeSource::point_towards(const PreparedScene& scene, const Vec2& uv, const Vec3& x,
                               LightSample& out) const {
  if (sampled_ != no_primitive)
    return troffer::sample(scene.scene, scene.primitives[size_t(sampled_)], x, uv, out);
  SourcePoint p = surface_.point_at(uv);
  if (round_radius_ > 0)  // the patch's flat pieces are chords of the sphere
    p.point = round_centre_ + normalize(p.point - round_centre_) * round_radius_;
  const Vec3 towards = x - p.point;
  const float distance_squared = length_squared(towards);
  const float projected = dot(p.normal, towards);  // cosine times distance
  out.is_front = projected > 0;
  if (projected == 0 || (!out.is_front && !is_two_sided_)) return false;
  out.point = p.point;
  out.normal = out.is_front ? p.normal : -p.normal;
  out.wi = normalize(p.point - x);
  out.distance = std::sqrt(distance_squared);
  out.pdf_solid_angle = distance_squared * std::sqrt(distance_squared) /
                        (std::abs(projected) * float(surface_.area()));
  out.radiance = is_constant_ ? radiance_
                              : emitted_radiance(scene.scene, scene.scene.lights[size_t(light_)],
                                                 out.is_front, p.texture_uv, -out.wi);
  return out.pdf_solid_angle > 0 && std::isfinite(out.pdf_solid_angle);
}

bool TreeSource::sample(const PreparedScene& scene, const Vec2& uv, const Vertex& v,
                        const SurfaceScattering& s, float light_rays, TreeSourceSample& out) const {
  LightSample p;
  if (!point_towards(scene, uv, v.surface.position, p)) return false;
  const Vec3 wi = v.frame.to_local(p.wi);
  if (!v.is_consistent(p.wi, wi)) return false;
  Rgb f_cos = s.has_diffuse ? evaluate(s.diffuse, v.wo, wi) : Rgb{0};
  // Patches are seen by spawned rays only, so gloss does not sample them.
  if (s.has_rough && !is_patch()) {
    const BsdfValue rough = evaluate_with_pdf(s.specular, v.wo, wi);
    f_cos += rough.f_cos *
             (p.is_delta ? 1.0f : power_heuristic(light_rays * p.pdf_solid_angle, rough.pdf));
  }
  if (f_cos.is_black()) return false;
  out.value = f_cos * p.radiance / p.pdf_solid_angle;
  if (out.value.is_black()) return false;
  out.shadow_ray = shadow_ray_to(v.surface, p);
  return true;
}

float TreeSource::pdf_of_hit(const PreparedScene& scene, const Vec3& from, const Vec3& direction,
                             const Vertex& v) const {
  const Vec3 d = v.surface.position - from;
  const float distance_squared = length_squared(d);
  if (sampled_ != no_primitive)
    return pdf_solid_angle(scene.scene, scene.primitives[size_t(sampled_)], from, direction,
                           std::sqrt(distance_squared));
  const float cosine = std::abs(dot(v.surface.geometric_normal, direction));
  return cosine > 0 ? distance_squared / (cosine * float(surface_.area())) : 0;
}

}  // namespace troffer
