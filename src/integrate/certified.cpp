#include "integrate/certified.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "base/warp.h"

namespace troffer {

namespace {

// Mirrors facing each other would reflect for ever.
constexpr uint32_t longest_chain = 64;
// From this error on the coarse lattice does, whose own error is up to .005 (docs/certified.md);
// specks and wires that fall between its samples would show below.
constexpr double coarse_from = 0.02;
// Below these, the fine lattice lies over quarters and sixteenths of sources.
constexpr double quarters_below = 0.002, sixteenths_below = 0.0007;

}  // namespace

CertifiedSettings certified_settings(double error, size_t lights) {
  // Half in shadow, the error of n Owen-Sobol rays is near 1/2 n^-3/4. Those of equal, independent
  // sources average out. Powers of two are stratified best.
  const auto rays_for = [](double e) {
    const double n = std::clamp(std::pow(0.25 / (e * e), 2.0 / 3), 16.0, 256.0);
    return int(std::bit_floor(unsigned(n)));
  };
  CertifiedSettings s;
  s.shadow_rays = rays_for(error * std::sqrt(double(std::max<size_t>(lights, 1))));
  s.estimator.lattice = error >= coarse_from ? coarse_lattice : fine_lattice;
  s.estimator.cells.most_share = error < sixteenths_below ? 0.1 : error < quarters_below ? 0.4 : 1;
  s.error = error;
  s.estimator.residual_error = float(error);
  s.estimator.rays.pair_error = float(2 * error);
  // Who asks for less than the default error may wait for it.
  s.estimator.rays.most_rays = uint32_t(256 * std::clamp(0.01 / error, 1.0, 16.0));
  s.estimator.rays.most_share_rays = 2 * s.estimator.rays.most_rays;
  return s;
}

struct CertifiedIntegrator::Scratch final : IntegratorScratch {
  Scratch(const CertifiedOptions& options, ShadowWorld world, SourceIntegrand integrand)
      : lights(options, std::move(world), std::move(integrand)),
        patches(CertifiedPatches::options(options)) {}
  CertifiedLightsScratch lights;
  CertifiedPatchesScratch patches;
  SourceSamplerScratch rays;
  std::vector<Walk> walks, next_walks;
  WalkScratch trace;
};

CertifiedIntegrator::CertifiedIntegrator(const PreparedScene& scene,
                                         std::optional<RadiosityLight> radiosity,
                                         const CertifiedSettings& settings)
    : scene_(scene),
      radiosity_(radiosity),
      settings_(settings),
      occluders_(scene.scene),
      lights_(scene, settings.error),
      sampler_(scene) {
  if (radiosity_)
    patches_ = CertifiedPatches(scene, radiosity_->solution(), radiosity_->selection());
}

std::unique_ptr<IntegratorScratch> CertifiedIntegrator::make_scratch() const {
  return std::make_unique<Scratch>(settings_.estimator,
                                   ShadowWorld(scene_.scene, occluders_, scene_.tracer),
                                   SourceIntegrand(scene_, uint32_t(settings_.gloss_samples)));
}

void CertifiedIntegrator::radiance(const ViewingRays& rays, IntegratorScratch& scratch,
                                   RadianceBatch& out, Counters& counters) const {
  auto& s = static_cast<Scratch&>(scratch);
  lights_.forget(s.lights);
  patches_.forget(s.patches);
  out.tell_variance();
  start_walks(rays, s.walks);
  counters.viewing_rays += rays.size();
  for (Coherence c = Coherence::coherent; !s.walks.empty(); c = Coherence::none) {
    trace_walks(scene_.tracer, s.walks, c, s.trace, counters);
    s.next_walks.clear();
    for (size_t i = 0; i < s.walks.size(); ++i) {
      const Hit& hit = s.trace.hits[i];
      if (!hit.is_valid()) continue;
      Walk& walk = s.walks[i];
      Vertex v;
      make_vertex(scene_.scene, walk.ray, hit, v);
      if (v.surface.light >= 0) add_emission(walk, v, out);
      // Without indirect light it left a glossy surface only to look for emission.
      if (!radiosity_ && walk.scatterings > 0) continue;
      const SurfaceScattering scattering(make_bsdf(scene_.bsdf_tables, scene_.scene,
                                                   v.surface.material, v.surface.uv, v.is_front));
      if (walk.vertex == 0) record_first_hit(walk, v, scattering.whole, out);
      if (walk.vertex == 0 && !out.records.empty())  // light has no noise worth a pattern
        out.records[walk.index] = {
            v.surface.geometry, v.is_front, v.frame.normal, v.surface.position, {}};
      light(walk, v, scattering, s, out, counters);
      if (radiosity_ && scattering.has_diffuse) add_indirect(walk, hit, v, scattering, s, out);
      if (scattering.has_specular && walk.vertex < longest_chain &&
          step(walk, v, scattering.specular, lobe_number(walk), direction_number(walk)) &&
          survives_spawning(walk))
        s.next_walks.push_back(walk);
    }
    lights_.illuminate(s.lights, out, counters);
    patches_.illuminate(s.patches, s.lights.world, out, counters);
    sampler_.resolve(s.rays, out, counters);
    s.walks.swap(s.next_walks);
  }
}

void CertifiedIntegrator::add_emission(const Walk& walk, const Vertex& v,
                                       RadianceBatch& out) const {
  const Rgb radiance = emission_at(scene_, v);
  if (radiance.is_black()) return;
  const float weight = emission_weight(walk, v);
  // Straight from a source: by mirrors and clear glass, or by the one rough surface it is seen in.
  const bool is_direct = walk.scatterings == 0 || (walk.scatterings == 1 && walk.pdf > 0);
  if (!is_direct && !radiosity_) return;
  const Rgb light = walk.throughput * radiance * weight;
  // The variance of one sample is no more than the mean of its square.
  out.add(walk.index, is_direct, light, walk.pdf > 0 ? sqr(luminance(light)) : 0.0f);
}

// Of emission that a walk has run into, against points on the source chosen at the vertex before.
float CertifiedIntegrator::emission_weight(const Walk& walk, const Vertex& v) const {
  if (!(walk.pdf > 0)) return 1;
  const bool is_sampled = walk.last_both_sides || !lights_.has(uint32_t(v.surface.light));
  if (is_sampled) return sampler_.emission_weight(walk, v, uint32_t(settings_.shadow_rays));
  const int32_t primitive = primitive_at(scene_, v.surface);
  const CertifiedSource* source =
      primitive < 0 ? nullptr
                    : lights_.source_of(uint32_t(primitive), !v.is_front, v.surface.position);
  if (source == nullptr) return 1;
  return power_heuristic(walk.pdf, float(settings_.gloss_samples) *
                                       nominal_density(*source, walk.last_position,
                                                       walk.last_normal, walk.ray.direction));
}

// Light straight from all sources at a vertex: by certificates later, or by rays.
void CertifiedIntegrator::light(const Walk& walk, const Vertex& v,
                                const SurfaceScattering& scattering, Scratch& s, RadianceBatch& out,
                                Counters& counters) const {
  const bool is_direct = walk.scatterings == 0;
  if (!scattering.has_diffuse && !scattering.has_rough) return;
  const bool is_certified = !scattering.is_transmitting();
  if (is_certified && !lights_.is_empty()) {
    if (scattering.is_lambertian)
      s.lights.hits.add_matte(walk, v, scattering.whole.diffuse, is_direct);
    else
      s.lights.hits.add_glossy(walk, v, scattering, is_direct);
  }
  const SampledVertex at{walk,
                         v,
                         scattering.has_diffuse ? &scattering.diffuse : nullptr,
                         scattering.has_rough ? &scattering.specular : nullptr,
                         scattering.whole.has_transmission,
                         is_direct};
  for (uint32_t e = 0; e < sampler_.lights(); ++e) {
    if (sampler_.is_empty(e) || (is_certified && lights_.has(e))) continue;
    sampler_.sample(at, e, uint32_t(settings_.shadow_rays), s.rays, out, counters);
    ++counters.mixed;
    if (walk.vertex == 0) out.sources[walk.index] += Rgb{1, 0, 0};
  }
}

void CertifiedIntegrator::add_indirect(const Walk& walk, const Hit& hit, const Vertex& v,
                                       const SurfaceScattering& scattering, Scratch& s,
                                       RadianceBatch& out) const {
  const RadiosityPlace place = radiosity_->place_of(hit, v);
  if (place.point == no_point) return;
  const Rgb reflectance = albedo(scattering.diffuse, v.wo.z);
  out.indirect[walk.index] +=
      walk.throughput * reflectance * inv_pi_f * radiosity_->general(place).indirect;
  patches_.add(walk, v, reflectance, radiosity_->solution().mesh.points[place.point].patch,
               s.patches);
}

void CertifiedIntegrator::irradiance(const SensorBatch& sensors, IntegratorScratch& scratch,
                                     RadianceBatch& out, Counters& counters) const {
  auto& s = static_cast<Scratch&>(scratch);
  lights_.forget(s.lights);
  out.tell_variance();
  const SurfaceScattering scattering(sensor_bsdf());
  for (uint32_t i = 0; i < sensors.size(); ++i)
    light(sensor_walk(sensors, i),
          make_sensor_vertex(sensors.positions[i], sensors.normals[i], sensors.offset), scattering,
          s, out, counters);
  lights_.illuminate(s.lights, out, counters);
  sampler_.resolve(s.rays, out, counters);
  if (radiosity_) gather(sensors, s, out, counters);
}

void CertifiedIntegrator::gather(const SensorBatch& sensors, Scratch& s, RadianceBatch& out,
                                 Counters& counters) const {
  s.walks.clear();
  for (uint32_t i = 0; i < sensors.size(); ++i) {
    Walk walk = sensor_walk(sensors, i);
    const Vertex v = make_sensor_vertex(sensors.positions[i], sensors.normals[i], sensors.offset);
    const Vec3 wi = v.frame.to_world(cosine_hemisphere_from_square(direction_number(walk)));
    walk.ray.origin = offset_origin(v.surface, wi);
    walk.ray.direction = wi;
    walk.vertex = 1;
    s.walks.push_back(walk);
  }
  trace_walks(scene_.tracer, s.walks, Coherence::none, s.trace, counters);
  for (uint32_t i = 0; i < sensors.size(); ++i)
    if (s.trace.hits[i].is_valid())
      out.indirect[i] += radiosity_->radiance_seen(s.walks[i].ray, s.trace.hits[i]) * pi_f;
}

}  // namespace troffer
