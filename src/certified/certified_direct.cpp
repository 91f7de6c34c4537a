#include "certified/certified_direct.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "base/ablation.h"
#include "base/error.h"

namespace troffer {

namespace {

// Allowed error from which the coarse lattice is used. Its own error is up to .005
// (docs/results/certified.md, "The lattice"); smaller errors need a lattice that also resolves
// specks and wires.
constexpr double coarse_from = 0.02;
// Allowed error where only a mean over many hits counts (SampleRequest::is_coarse).
constexpr double rough_error = 0.3;

}  // namespace

CertifiedSettings certified_settings(double error, size_t lights, int viewing_rays) {
  // At a point half in shadow, n Owen-Sobol rays have an error of about 1/2 n^-3/4, so
  // n = (1 / 4e²)^(2/3). Errors of equal, independent sources average out. Powers of two are
  // stratified best.
  const auto rays_for = [](double e) {
    const double n = std::clamp(std::pow(0.25 / (e * e), 2.0 / 3), 16.0, 256.0);
    return int(std::bit_floor(unsigned(n)));
  };
  // With this many points, the error of glossy light stays below `e`, and below what edges
  // contribute in pixels of few viewing rays.
  const auto points_for = [](double e) {
    return int(std::bit_floor(unsigned(std::clamp(3.2 / e, 8.0, 32.0))));
  };
  CertifiedSettings s;
  s.gloss_samples = points_for(error);
  s.shadow_rays = rays_for(error * std::sqrt(double(std::max<size_t>(lights, 1))));
  s.estimator.lattice =
      error >= coarse_from && !is_left_out<"coarse masks">() ? coarse_lattice : fine_lattice;
  // Errors of a pixel's viewing rays are independent.
  s.estimator.mask_error = float(error * std::sqrt(std::clamp(viewing_rays, 1, 4)));
  s.error = error;
  s.viewing_rays = viewing_rays;
  s.estimator.viewing_rays = uint32_t(std::max(viewing_rays, 1));
  s.estimator.residual_error = float(error);
  s.estimator.rays.pair_error = float(2 * error);
  s.estimator.rays.most_rays =
      uint32_t(std::clamp(2.56 / error, 256.0, double(most_rays_of_receiver)));
  s.estimator.rays.most_direct_rays =
      uint32_t(std::clamp(40 / error, 128.0, double(most_rays_of_receiver)));
  s.estimator.rays.most_share_rays = 2 * s.estimator.rays.most_rays;
  return s;
}

struct CertifiedDirect::Scratch final : DirectLightScratch {
  Scratch(const CertifiedOptions& options, ShadowWorld world, SourceIntegrand integrand)
      : lights(options, std::move(world), std::move(integrand)) {}
  CertifiedLightsScratch lights;
  SourceSamplerScratch rays;
};

CertifiedDirect::CertifiedDirect(const PreparedScene& scene,
                                 std::shared_ptr<const Occluders> occluders,
                                 const CertifiedSettings& settings)
    : scene_(scene),
      occluders_(std::move(occluders)),
      settings_(settings),
      lights_(scene,
              {float(settings.error), float(settings.viewing_rays), uint32_t(settings.draws),
               uint32_t(settings.matte_draw_factor)},
              uint32_t(settings.gloss_samples)),
      sampler_(scene) {
  lights_.set_occluders(*occluders_);
  for (uint32_t light = 0; light < sampler_.lights(); ++light) {
    if (sampler_.is_empty(light)) continue;
    at_transmitting_.push_back(light);
    if (!lights_.sources().has(light)) at_opaque_.push_back(light);
  }
}

std::unique_ptr<DirectLightScratch> CertifiedDirect::make_scratch() const {
  return std::make_unique<Scratch>(
      settings_.estimator, ShadowWorld(scene_.scene, *occluders_, scene_.tracer),
      SourceIntegrand(scene_, uint32_t(settings_.gloss_samples), lights_.sources().competition()));
}

void CertifiedDirect::begin(const SampleRequest& request, DirectLightScratch& scratch) const {
  auto& s = static_cast<Scratch&>(scratch);
  lights_.forget(s.lights);
  s.lights.request = request;
  s.lights.options = options_for(request);
}

void CertifiedDirect::queue(WaveHits& wave, DirectLightScratch& scratch, RadianceBatch& out,
                            Counters& counters) const {
  auto& s = static_cast<Scratch&>(scratch);
  CheckItems items;
  for (size_t i = 0; i < wave.size(); ++i) {
    items.at(wave.walks[i].index);
    queue_hit(wave, i, s, out, counters);
  }
}

void CertifiedDirect::flush(DirectLightScratch& scratch, RadianceBatch& out,
                            Counters& counters) const {
  auto& s = static_cast<Scratch&>(scratch);
  lights_.illuminate(s.lights, out, counters);
  sampler_.resolve(s.rays, out, counters);
}

CertifiedOptions CertifiedDirect::options_for(const SampleRequest& request) const {
  const double largest = std::max(rough_error, settings_.error);
  if (request.is_coarse) return certified_settings(largest, 1, 1).estimator;
  if (request.error_scale <= 1) return settings_.estimator;
  const double error = std::min(settings_.error * double(request.error_scale), largest);
  return certified_settings(error, 1, settings_.viewing_rays).estimator;
}

// Queues a hit for certificates, and casts shadow rays to the other lights.
void CertifiedDirect::queue_hit(const WaveHits& wave, size_t i, Scratch& s, RadianceBatch& out,
                                Counters& counters) const {
  const Walk& walk = wave.walks[i];
  const Vertex& v = wave.vertices[i];
  const SurfaceScattering& scattering = wave.scatterings[i];
  if (!scattering.has_diffuse && !scattering.has_rough) return;
  const bool is_direct = is_direct_at(walk);
  const bool is_certified = !scattering.is_transmitting();
  if (is_certified && !lights_.sources().is_empty()) {
    if (scattering.is_lambertian)
      s.lights.hits.add_matte(walk, v, scattering.whole.diffuse, is_direct);
    else
      s.lights.hits.add_glossy(walk, v, scattering, lights_.sources().competition(), is_direct);
  }
  const SampledVertex at{walk,
                         v,
                         scattering.has_diffuse ? &scattering.diffuse : nullptr,
                         scattering.has_rough ? &scattering.specular : nullptr,
                         scattering.whole.has_transmission,
                         is_direct};
  for (const uint32_t light : is_certified ? at_opaque_ : at_transmitting_) {
    sampler_.sample(at, light, uint32_t(settings_.shadow_rays), s.rays, out, counters);
    ++counters.mixed;
    if (walk.vertex == 0) out.sources[walk.index] += Rgb{1, 0, 0};
  }
}

void CertifiedDirect::weigh(SeenEmission& seen) const {
  for (size_t i = 0; i < seen.size(); ++i)
    seen.weights[i] = seen.vertices[i] == nullptr
                          ? weight_of_miss(*seen.walks[i], seen.at_infinity[i])
                          : weight_of(*seen.walks[i], *seen.vertices[i]);
}

float CertifiedDirect::weight_against(const CertifiedSource& source, const Walk& walk) const {
  const NominalSourceDensity& competitor = lights_.sources().competition();
  const SurfacePlace at = source.far != nullptr
                              ? SurfacePlace{walk.last_position, walk.last_normal}
                              : competitor.place(walk.last_position, walk.last_normal);
  return power_heuristic(walk.pdf, competitor.density(source, at, walk.ray.direction));
}

float CertifiedDirect::weight_of_miss(const Walk& walk, uint32_t primitive) const {
  if (walk.last_both_sides || !lights_.sources().has(scene_.primitives[primitive].light))
    return sampler_.miss_weight(walk, primitive, uint32_t(settings_.shadow_rays));
  const CertifiedSource* source = lights_.sources().source_towards(primitive, walk.ray.direction);
  if (source == nullptr) return 1;
  return weight_against(*source, walk);
}

// MIS weight of emission that a walk hit, against sampling the source from the previous vertex.
float CertifiedDirect::weight_of(const Walk& walk, const Vertex& v) const {
  const bool is_sampled = walk.last_both_sides || !lights_.sources().has(uint32_t(v.surface.light));
  if (is_sampled) return sampler_.emission_weight(walk, v, uint32_t(settings_.shadow_rays));
  const int32_t primitive = primitive_at(scene_, v.surface);
  if (primitive >= 0 && lights_.sources().is_drawn(uint32_t(v.surface.light))) {
    const NominalSourceDensity& competitor = lights_.sources().competition();
    return power_heuristic(
        walk.pdf, competitor.density(uint32_t(primitive),
                                     competitor.place(walk.last_position, walk.last_normal),
                                     walk.ray.direction));
  }
  const CertifiedSource* source =
      primitive < 0
          ? nullptr
          : lights_.sources().source_of(uint32_t(primitive), !v.is_front, v.surface.position);
  if (source == nullptr) return 1;
  return weight_against(*source, walk);
}

}  // namespace troffer
