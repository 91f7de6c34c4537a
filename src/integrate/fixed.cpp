#include "integrate/fixed.h"

#include <numeric>

#include "base/random.h"
#include "integrate/purposes.h"

namespace troffer {

namespace {

// Mirrors facing each other would reflect for ever.
constexpr uint32_t longest_chain = 64;
// Shadow rays are traced when so many have gathered.
constexpr size_t shadow_batch = 8192;

}  // namespace

struct FixedIntegrator::Scratch final : IntegratorScratch {
  std::vector<Walk> walks;
  WalkScratch trace;
  ShadowBatch shadows;
  // The samples of one source from one vertex.
  std::vector<uint64_t> streams;
  std::vector<uint32_t> samples, primitives;
  std::vector<float> numbers, pmfs, u, v;
  std::vector<Vec3> receivers;
  std::vector<EmitterSample> points;
  std::vector<uint8_t> is_valid;
  EmitterSampleScratch emitters;

  void resize(size_t n) {
    samples.resize(n);
    primitives.resize(n);
    numbers.resize(3 * n);
    pmfs.resize(n);
    u.resize(n);
    v.resize(n);
    points.resize(n);
    is_valid.resize(n);
  }
};

FixedIntegrator::FixedIntegrator(const PreparedScene& scene, const FixedOptions& options)
    : scene_(scene), options_(options) {
  for (uint32_t e = 0; e < scene.scene.emitters.size(); ++e)
    trees_.emplace_back(scene.lights, scene.lights.of_emitter(e));
}

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
      if (v.surface.emitter >= 0) add_emission(walk, v, out);
      if (walk.scatterings > 0) continue;  // it left a glossy surface only to look for emission
      const Bsdf bsdf =
          make_bsdf(scene_.bsdf_tables, scene_.scene, v.surface.material, v.surface.uv, v.is_front);
      if (walk.vertex == 0) record_first_hit(walk, v, bsdf, out);
      if (!is_purely_delta(bsdf)) sample_sources(walk, v, bsdf, s, out, counters);
      if (is_lambertian(bsdf, nullptr) || walk.vertex >= longest_chain) continue;
      if (step(walk, v, bsdf, lobe_number(walk), direction_number(walk))) s.walks[alive++] = walk;
    }
    s.walks.resize(alive);
    s.shadows.resolve(scene_.tracer, Coherence::coherent, out, counters);
  }
}

void FixedIntegrator::irradiance(const SensorBatch& sensors, IntegratorScratch& scratch,
                                 RadianceBatch& out, Counters& counters) const {
  auto& s = static_cast<Scratch&>(scratch);
  for (uint32_t i = 0; i < sensors.size(); ++i)
    sample_sources(sensor_walk(sensors, i),
                   make_sensor_vertex(sensors.positions[i], sensors.normals[i], sensors.offset),
                   sensor_bsdf(), s, out, counters);
  s.shadows.resolve(scene_.tracer, Coherence::coherent, out, counters);
}

void FixedIntegrator::add_emission(const Walk& walk, const Vertex& v, RadianceBatch& out) const {
  const Rgb radiance = emission_at(scene_, v);
  if (radiance.is_black()) return;
  const int32_t primitive = walk.pdf > 0 ? primitive_at(scene_, v.surface) : no_primitive;
  const float weight = primitive < 0
                           ? 1
                           : emission_weight(scene_, trees_[size_t(v.surface.emitter)], walk, v,
                                             uint32_t(primitive), float(options_.shadow_rays));
  out.direct[walk.index] += walk.throughput * radiance * weight;
}

void FixedIntegrator::sample_sources(const Walk& walk, const Vertex& v, const Bsdf& bsdf,
                                     Scratch& s, RadianceBatch& out, Counters& counters) const {
  for (uint32_t e = 0; e < trees_.size(); ++e) {
    if (trees_[e].is_empty()) continue;
    sample_source(walk, v, bsdf, e, s);
    // Rays of one vertex to one source stand side by side: packets pay.
    if (s.shadows.rays.size() >= shadow_batch)
      s.shadows.resolve(scene_.tracer, Coherence::coherent, out, counters);
  }
}

void FixedIntegrator::sample_source(const Walk& walk, const Vertex& v, const Bsdf& bsdf,
                                    uint32_t emitter, Scratch& s) const {
  const auto n = uint32_t(options_.shadow_rays);
  const LightTree& tree = trees_[emitter];
  s.resize(n);
  s.receivers.assign(n, v.surface.position);
  s.streams.assign(n, hash_combine(walk.stream, emitter + 1));
  std::iota(s.samples.begin(), s.samples.end(), walk.sample * n);
  sobol_groups(s.streams.data(), s.samples.data(), n, purpose_light(walk.vertex), 3,
               s.numbers.data());
  uint32_t chosen = 0;
  for (uint32_t j = 0; j < n; ++j) {
    const LightChoice choice = tree.choose(v.surface.position, v.geometric_normal,
                                           bsdf.has_transmission, s.numbers[2 * n + j]);
    if (choice.pmf == 0) continue;  // of these primitives none can send light here
    s.primitives[chosen] = choice.primitive;
    s.pmfs[chosen] = choice.pmf;
    s.u[chosen] = s.numbers[j];
    s.v[chosen] = s.numbers[n + j];
    ++chosen;
  }
  sample_many(scene_.lights, chosen, s.primitives.data(), s.receivers.data(), s.u.data(),
              s.v.data(), s.points.data(), s.is_valid.data(), s.emitters);
  const bool uses_lobe = !is_lambertian(bsdf, nullptr);  // combined with a sample of the BSDF's own
  for (uint32_t j = 0; j < chosen; ++j) {
    LightConnection c;
    if (s.is_valid[j] == 0 ||
        !connect(scene_, v, bsdf, scene_.lights[s.primitives[j]], s.points[j], c))
      continue;
    const float pdf_light = c.pdf_light * s.pmfs[j] * float(n);
    const float weight = uses_lobe ? power_heuristic(pdf_light, c.pdf_bsdf) : 1;
    s.shadows.add(c.shadow_ray, walk.throughput * c.value * (weight / pdf_light), walk.index, true);
  }
}

}  // namespace troffer
