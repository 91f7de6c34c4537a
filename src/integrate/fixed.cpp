#include "integrate/fixed.h"

#include <vector>

namespace troffer {

namespace {

// Mirrors facing each other would reflect for ever.
constexpr uint32_t longest_chain = 64;

}  // namespace

struct FixedIntegrator::Scratch final : IntegratorScratch {
  std::vector<Walk> walks;
  WalkScratch trace;
  SourceSamplerScratch lights;
};

FixedIntegrator::FixedIntegrator(const PreparedScene& scene, const FixedOptions& options)
    : scene_(scene), options_(options), sampler_(scene) {}

std::unique_ptr<IntegratorScratch> FixedIntegrator::make_scratch() const {
  return std::make_unique<Scratch>();
}

void FixedIntegrator::radiance(const ViewingRays& rays, IntegratorScratch& scratch,
                               RadianceBatch& out, Counters& counters) const {
  auto& s = static_cast<Scratch&>(scratch);
  start_walks(rays, s.walks);
  counters.viewing_rays += rays.size();
  for (Coherence c = Coherence::coherent; !s.walks.empty(); c = Coherence::none) {
    trace_walks(scene_.tracer, s.walks, c, s.trace, counters);
    size_t alive = 0;
    for (size_t i = 0; i < s.walks.size(); ++i) {
      const Hit& hit = s.trace.hits[i];
      if (!hit.is_valid()) continue;
      Walk& walk = s.walks[i];
      Vertex v;
      make_vertex(scene_.scene, walk.ray, hit, v);
      if (v.surface.light >= 0) add_emission(walk, v, out);
      if (walk.scatterings > 0) continue;  // it left a glossy surface only to look for emission
      const Bsdf bsdf =
          make_bsdf(scene_.bsdf_tables, scene_.scene, v.surface.material, v.surface.uv, v.is_front);
      if (walk.vertex == 0) record_first_hit(walk, v, bsdf, out);
      if (!is_purely_delta(bsdf)) sample_sources(walk, v, bsdf, s, out, counters);
      if (is_lambertian(bsdf, nullptr) || walk.vertex >= longest_chain) continue;
      if (step(walk, v, bsdf, lobe_number(walk), direction_number(walk))) s.walks[alive++] = walk;
    }
    s.walks.resize(alive);
    sampler_.resolve(s.lights, out, counters);
  }
}

void FixedIntegrator::irradiance(const SensorBatch& sensors, IntegratorScratch& scratch,
                                 RadianceBatch& out, Counters& counters) const {
  auto& s = static_cast<Scratch&>(scratch);
  for (uint32_t i = 0; i < sensors.size(); ++i)
    sample_sources(sensor_walk(sensors, i),
                   make_sensor_vertex(sensors.positions[i], sensors.normals[i], sensors.offset),
                   sensor_bsdf(), s, out, counters);
  sampler_.resolve(s.lights, out, counters);
}

void FixedIntegrator::add_emission(const Walk& walk, const Vertex& v, RadianceBatch& out) const {
  const Rgb radiance = emission_at(scene_, v);
  if (radiance.is_black()) return;
  out.direct[walk.index] += walk.throughput * radiance *
                            sampler_.emission_weight(walk, v, uint32_t(options_.shadow_rays));
}

void FixedIntegrator::sample_sources(const Walk& walk, const Vertex& v, const Bsdf& bsdf,
                                     Scratch& s, RadianceBatch& out, Counters& counters) const {
  const bool is_matte = is_lambertian(bsdf, nullptr);  // else a sample of its own competes
  const SampledVertex at{walk, v, is_matte ? &bsdf : nullptr, is_matte ? nullptr : &bsdf,
                         bsdf.has_transmission};
  for (uint32_t e = 0; e < sampler_.lights(); ++e)
    if (!sampler_.is_empty(e))
      sampler_.sample(at, e, uint32_t(options_.shadow_rays), s.lights, out, counters);
}

}  // namespace troffer
