#include "certified/source_integrand.h"

#include <algorithm>

#include "base/simd.h"
#include "bsdf/evaluate_many.h"
#include "light/irradiance.h"
#include "light/polygon.h"
#include "transport/connect.h"

namespace troffer {

Box CertifiedSource::bounds() const {
  Box box;
  if (is_round) {
    const auto reach = float(sphere.radius);
    box.grow(Vec3(sphere.centre) - Vec3{reach, reach, reach});
    box.grow(Vec3(sphere.centre) + Vec3{reach, reach, reach});
    return box;
  }
  const Parallelogram& p = flat.plane;
  for (const Vec3d& corner : {p.origin, p.origin + p.u, p.origin + p.v, p.origin + p.u + p.v})
    box.grow(Vec3(corner));
  return box;
}

double CertifiedSource::unoccluded(const Vec3d& x, const Vec3d& n) const {
  if (is_round) return sphere_irradiance(sphere.centre, sphere.radius, x, n);
  const Parallelogram& p = flat.plane;
  if (dot(p.normal, x - p.origin) <= plane_rounding(x, p.origin)) return 0;
  if (flat.is_disk)
    return disk_irradiance(p.origin + (p.u + p.v) * 0.5, p.normal, 0.5 * length(p.u), x, n);
  return polygon_irradiance(flat.corners(), x, n, Sides::both);
}

Rgb glossy_value(const GlossyHit& g, const Vec3& world, float density) {
  const Vec3 wi = g.frame.to_local(world);
  const float cosine = dot(world, g.place.n);
  Rgb f_cos;
  if (!(cosine > 0) || !(wi.z > 0)) return f_cos;
  if (g.has_diffuse) f_cos += troffer::evaluate(g.diffuse, g.wo, wi);
  if (g.has_rough && density > 0) {
    const BsdfValue rough = evaluate_with_pdf(g.rough, g.wo, wi);
    f_cos += rough.f_cos * power_heuristic(density, rough.pdf);
  }
  return f_cos;
}

Rgb low_variance_value(const GlossyHit& hit, const CertifiedSource& source, const Vec3& x) {
  const auto at = [&](const Vec3d& way, double weight, Rgb& sum, double& weights) {
    const Vec3 wi = hit.frame.to_local(Vec3(way * (1 / std::max(length(way), 1e-300))));
    weight *= double(wi.z);
    if (!(weight > 0)) return;
    sum += troffer::evaluate(hit.diffuse, hit.wo, wi) * (float(weight) / wi.z);
    weights += weight;
  };
  Rgb sum;
  double weights = 0;
  if (source.is_round) {
    at(source.sphere.centre - Vec3d(x), 1, sum, weights);
  } else {
    const Parallelogram& p = source.flat.plane;
    for (const double u : {0.25, 0.75})
      for (const double v : {0.25, 0.75}) {
        const Vec3d way = p.origin + p.u * u + p.v * v - Vec3d(x);
        at(way, 1 / std::max(length_squared(way), 1e-300), sum, weights);
      }
  }
  // A source with no point above the horizon is evaluated just above it.
  if (!(weights > 0)) at(Vec3d(hit.frame.normal) + Vec3d(hit.frame.tangent) * 10, 1, sum, weights);
  return sum * float(1 / weights);
}

Rgb SourceIntegrand::radiance_at(const CertifiedSource& source, const Vec3& point,
                                 const Vec3& receiver) const {
  if (!source.is_textured) return source.radiance;
  if (source.far != nullptr) {
    const Vec3 d = point - receiver;
    Rgb l;
    far_radiance(*source.far, 1, &d.x, &d.y, &d.z, &l.r, &l.g, &l.b);
    return l;
  }
  const LightPrimitive& p = scene_.primitives[source.primitive];
  if (source.is_by_web)
    return emitted_radiance(scene_.scene, scene_.scene.lights[p.light], !source.is_back, {},
                            normalize(receiver - point));
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
    take_on_the_way(request, hit.position, points, values);
    return;
  }
  const GlossyHit& g = *hit.glossy;
  const float density = g.has_rough ? competition_.density_of(source, g.place) : 0;
  for (size_t i = 0; i < points.size(); ++i) {
    const Vec3 wi = normalize(points[i] - hit.position);
    const float cosine = dot(wi, g.frame.normal);
    values[i] = {};
    if (cosine > 0)
      values[i] = glossy_value(g, wi, density * dot(wi, g.place.n)) * (1 / cosine) *
                  radiance_at(source, points[i], hit.position);
  }
  take_on_the_way(request, hit.position, points, values);
}

void SourceIntegrand::take_on_the_way(uint32_t request, const Vec3& receiver,
                                      std::span<const Vec3> points, std::span<Rgb> values) const {
  if (!is_taken_on_the_way(request)) return;
  for (size_t i = 0; i < points.size(); ++i)
    if (!values[i].is_black())
      values[i] *= left_on_the_way(request, receiver, points[i] - receiver);
}

// A pane that contains the receiver itself is skipped.
Rgb SourceIntegrand::left_on_the_way(uint32_t request, const Vec3& receiver,
                                     const Vec3& way) const {
  if (portals_[request] != nullptr && !portals_[request]->shows(receiver, way)) return Rgb{0};
  if (!is_behind_panes(request)) return Rgb{1};
  const PanesBetween& panes = behind_panes_[request];
  if (panes.are_simple) return scene_.panes.transmittance(panes, receiver, way);
  Ray ray{receiver, 0, way, 1};
  const Vec3 at = abs(receiver);
  ray.t_min = ray_offset(std::max({at.x, at.y, at.z})) / std::max(length(way), 1e-30f);
  ray.t_max = 1 - 4e-6f;
  return scene_.tracer.transmittance(ray);
}

namespace {

TROFFER_MULTIVERSION
void to_local(const Frame& f, const Vec3& geometric, size_t n, const float* __restrict px,
              const float* __restrict py, const float* __restrict pz, float* __restrict x,
              float* __restrict y, float* __restrict z, float* __restrict above) {
  const Vec3 t = f.tangent, b = f.bitangent, m = f.normal;
  for (size_t i = 0; i < n; ++i) {
    const float s = 1 / std::sqrt(px[i] * px[i] + py[i] * py[i] + pz[i] * pz[i]);
    const float dx = px[i] * s, dy = py[i] * s, dz = pz[i] * s;
    x[i] = dx * t.x + dy * t.y + dz * t.z;
    y[i] = dx * b.x + dy * b.y + dz * b.z;
    z[i] = dx * m.x + dy * m.y + dz * m.z;
    above[i] = dx * geometric.x + dy * geometric.y + dz * geometric.z;
  }
}

// Adds the rough part times its MIS weight, power_heuristic().
TROFFER_MULTIVERSION
void add_rough(float density, size_t n, const float* __restrict above, const float* __restrict pdf,
               const float* __restrict r, const float* __restrict g, const float* __restrict b,
               float* __restrict to_r, float* __restrict to_g, float* __restrict to_b) {
  for (size_t i = 0; i < n; ++i) {
    const float own = density * above[i];
    const float ratio = pdf[i] / std::max(own, 1e-30f);
    const float weight = own > 0 ? 1 / (1 + ratio * ratio) : 0.0f;
    to_r[i] += r[i] * weight;
    to_g[i] += g[i] * weight;
    to_b[i] += b[i] * weight;
  }
}

TROFFER_MULTIVERSION
void multiply(const float* __restrict by, size_t n, float* __restrict values) {
  for (size_t i = 0; i < n; ++i) values[i] *= by[i];
}

// Multiplies by radiance / cosine; 0 below either horizon.
TROFFER_MULTIVERSION
void scale_all(const Rgb& radiance, size_t n, const float* __restrict z,
               const float* __restrict above, float* __restrict r, float* __restrict g,
               float* __restrict b) {
  for (size_t i = 0; i < n; ++i) {
    const float s = z[i] > 0 && above[i] > 0 ? 1 / std::max(z[i], 1e-30f) : 0.0f;
    r[i] *= radiance.r * s;
    g[i] *= radiance.g * s;
    b[i] *= radiance.b * s;
  }
}

// Largest width of a source, in lobe widths, for which gloss has low variance. Measured:
// docs/log/certified-visibility.md, "Gloss and textures". Gathered gloss always counts as
// low-variance, since spawned rays handle its peaks.
constexpr float sources_in_lobe = 2;

// Returns the width of a source divided by its distance from x; very large if x may lie inside it.
float angular_width(const CertifiedSource& source, const Vec3& x) {
  if (source.is_round) {
    const double distance = length(source.sphere.centre - Vec3d(x));
    return float(2 * source.sphere.radius / std::max(distance - source.sphere.radius, 1e-30));
  }
  const Parallelogram& p = source.flat.plane;
  const double width = std::max(length(p.u + p.v), length(p.u - p.v));
  const double distance = length(p.origin + (p.u + p.v) * 0.5 - Vec3d(x));
  return float(width / std::max(distance - 0.5 * width, 1e-30));
}

// Approximate angular width of the lobe: twice the spread of its microfacet normals, narrowed by
// the cosine across the plane of incidence.
float lobe_width(const GlossyHit& g) {
  return 2 * glossy_alpha(g.rough) * std::max(g.wo.z, 0.0f);
}

}  // namespace

bool SourceIntegrand::is_low_variance(uint32_t request, uint32_t member) const {
  const CertifiedSource& source = *sources_[request];
  if (source.far != nullptr || is_taken_on_the_way(request)) return false;
  const GlossyHit* g = hits_[member].glossy;
  return g == nullptr || !g->has_rough || g->is_gathered ||
         angular_width(source, hits_[member].position) < sources_in_lobe * lobe_width(*g);
}

void SourceIntegrand::evaluate_many(uint32_t request, uint32_t member, PointArrays& p) {
  const CertifiedSource& source = *sources_[request];
  const IntegrandHit& hit = hits_[member];
  const size_t n = p.size();
  for (auto* a : {&p.r, &p.g, &p.b}) a->assign(n, 0);
  if (hit.glossy != nullptr) evaluate_gloss(source, hit, p);
  multiply_by_radiance(source, hit, p);
  if (!is_taken_on_the_way(request)) return;
  for (size_t i = 0; i < n; ++i) {
    const Rgb left = left_on_the_way(request, hit.position, {p.x[i], p.y[i], p.z[i]});
    p.r[i] *= left.r;
    p.g[i] *= left.g;
    p.b[i] *= left.b;
  }
}

void SourceIntegrand::multiply_by_radiance(const CertifiedSource& source, const IntegrandHit& hit,
                                           PointArrays& p) {
  const size_t n = p.size();
  const bool varies = source.far != nullptr && source.is_textured;
  if (source.is_by_web) {
    multiply_by_web(source, hit, p);
    return;
  }
  if (hit.glossy == nullptr) {
    if (varies)
      return far_radiance(*source.far, n, p.x.data(), p.y.data(), p.z.data(), p.r.data(),
                          p.g.data(), p.b.data());
    p.r.assign(n, source.radiance.r);
    p.g.assign(n, source.radiance.g);
    p.b.assign(n, source.radiance.b);
    return;
  }
  if (!varies) return;  // evaluate_gloss() has included the radiance
  far_values_.resize(3 * n);
  float* const r = far_values_.data();
  far_radiance(*source.far, n, p.x.data(), p.y.data(), p.z.data(), r, r + n, r + 2 * n);
  multiply(r, n, p.r.data());
  multiply(r + n, n, p.g.data());
  multiply(r + 2 * n, n, p.b.data());
}

namespace {

void scale_by(const Rgb& factor, PointArrays& p) {
  for (size_t i = 0; i < p.size(); ++i) {
    p.r[i] *= factor.r;
    p.g[i] *= factor.g;
    p.b[i] *= factor.b;
  }
}

}  // namespace

void SourceIntegrand::multiply_by_web(const CertifiedSource& source, const IntegrandHit& hit,
                                      PointArrays& p) {
  const Light& light = scene_.scene.lights[scene_.primitives[source.primitive].light];
  far_values_.resize(p.size());
  scene_.webs[size_t(light.web)].radiance_many(light.axes, p.size(), p.x.data(), p.y.data(),
                                               p.z.data(), web_lanes_, far_values_.data());
  if (hit.glossy == nullptr) {
    p.r.assign(p.size(), light.radiance.r);
    p.g.assign(p.size(), light.radiance.g);
    p.b.assign(p.size(), light.radiance.b);
  } else {
    scale_by(light.radiance, p);
  }
  for (auto* a : {&p.r, &p.g, &p.b}) multiply(far_values_.data(), p.size(), a->data());
}

// Sets the BRDF per unit of projected solid angle, times the radiance if it is uniform.
void SourceIntegrand::evaluate_gloss(const CertifiedSource& source, const IntegrandHit& hit,
                                     PointArrays& p) {
  const GlossyHit& g = *hit.glossy;
  const size_t n = p.size();
  lanes_.resize(n);
  GlossyLanes& l = lanes_;
  to_local(g.frame, g.place.n, n, p.x.data(), p.y.data(), p.z.data(), l.x.data(), l.y.data(),
           l.z.data(), l.above.data());
  if (g.has_diffuse)
    troffer::evaluate_many(
        g.diffuse, g.wo, n,
        {l.x.data(), l.y.data(), l.z.data(), p.r.data(), p.g.data(), p.b.data(), l.pdf.data()});
  const float density = g.has_rough ? competition_.density_of(source, g.place) : 0;
  if (density > 0) {
    troffer::evaluate_many(
        g.rough, g.wo, n,
        {l.x.data(), l.y.data(), l.z.data(), l.r.data(), l.g.data(), l.b.data(), l.pdf.data()});
    add_rough(density, n, l.above.data(), l.pdf.data(), l.r.data(), l.g.data(), l.b.data(),
              p.r.data(), p.g.data(), p.b.data());
  }
  const Rgb radiance = source.is_textured ? Rgb{1} : source.radiance;
  scale_all(radiance, n, l.z.data(), l.above.data(), p.r.data(), p.g.data(), p.b.data());
}

}  // namespace troffer
