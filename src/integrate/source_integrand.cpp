#include "integrate/source_integrand.h"

#include "integrate/connect.h"
#include "light/irradiance.h"
#include "light/polygon.h"

namespace troffer {

double CertifiedSource::unoccluded(const Vec3d& x, const Vec3d& n) const {
  if (is_round) return sphere_irradiance(sphere.centre, sphere.radius, x, n);
  const Parallelogram& p = flat.plane;
  if (dot(p.normal, x - p.origin) <= plane_rounding(x, p.origin)) return 0;
  if (flat.is_disk)
    return disk_irradiance(p.origin + (p.u + p.v) * 0.5, p.normal, 0.5 * length(p.u), x, n);
  return polygon_irradiance(flat.corners(), x, n, Sides::both);
}

namespace {

// Points that lights which are drawn are taken to share.
constexpr float shared_points = 8;

}  // namespace

float LobeCompetition::density_of(const CertifiedSource& source, const Vec3& x,
                                  const Vec3& n) const {
  const auto unoccluded = float(source.unoccluded(Vec3d(x), Vec3d(n)));
  if (!(unoccluded > 0)) return 0;
  const float points = are_many_
                           ? shared_points * scene_->light_tree.pmf(x, n, false, source.primitive)
                           : float(points_);
  return points / unoccluded;
}

float LobeCompetition::density(const CertifiedSource& source, const Vec3& x, const Vec3& n,
                               const Vec3& wi) const {
  const float cosine = dot(n, wi);
  return cosine > 0 ? density_of(source, x, n) * cosine : 0;
}

float LobeCompetition::density(uint32_t primitive, const Vec3& x, const Vec3& n,
                               float pdf_solid_angle) const {
  return shared_points * scene_->light_tree.pmf(x, n, false, primitive) * pdf_solid_angle;
}

Rgb glossy_value(const GlossyHit& g, const Vec3& world, float density) {
  const Vec3 wi = g.frame.to_local(world);
  const float cosine = dot(world, g.geometric_normal);
  Rgb f_cos;
  if (!(cosine > 0) || !(wi.z > 0)) return f_cos;
  if (g.has_diffuse) f_cos += troffer::evaluate(g.diffuse, g.wo, wi);
  if (g.has_rough && density > 0) {
    const BsdfValue rough = evaluate_with_pdf(g.rough, g.wo, wi);
    f_cos += rough.f_cos * power_heuristic(density, rough.pdf);
  }
  return f_cos;
}

Rgb SourceIntegrand::radiance_at(const CertifiedSource& source, const Vec3& point,
                                 const Vec3& receiver) const {
  if (!source.is_textured) return source.radiance;
  const LightPrimitive& p = scene_.primitives[source.primitive];
  const Vec3d a(p.vertices[0]), ab = Vec3d(p.vertices[1]) - a, ac = Vec3d(p.vertices[2]) - a;
  const Vec3d n = cross(ab, ac), d = Vec3d(point) - a;
  const double area2 = length_squared(n);
  const auto b1 = float(dot(cross(d, ac), n) / area2), b2 = float(dot(cross(ab, d), n) / area2);
  const Vec2 uv = p.uvs[0] * (1 - b1 - b2) + p.uvs[1] * b1 + p.uvs[2] * b2;
  return emitted_radiance(scene_.scene, scene_.scene.lights[p.light], !source.is_back, uv,
                          normalize(receiver - point));
}

void SourceIntegrand::evaluate(uint32_t request, uint32_t member, std::span<const Vec3> points,
                               std::span<Rgb> values) {
  const CertifiedSource& source = *sources_[request];
  const IntegrandHit& hit = hits_[member];
  if (hit.glossy == nullptr) {
    for (size_t i = 0; i < points.size(); ++i)
      values[i] = radiance_at(source, points[i], hit.position);
    return;
  }
  const GlossyHit& g = *hit.glossy;
  const float density =
      g.has_rough ? competition_.density_of(source, hit.position, g.geometric_normal) : 0;
  for (size_t i = 0; i < points.size(); ++i) {
    const Vec3 wi = normalize(points[i] - hit.position);
    const float cosine = dot(wi, g.frame.normal);
    values[i] = {};
    if (cosine > 0)
      values[i] = glossy_value(g, wi, density * dot(wi, g.geometric_normal)) * (1 / cosine) *
                  radiance_at(source, points[i], hit.position);
  }
}

}  // namespace troffer
