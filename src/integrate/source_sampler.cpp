#include "integrate/source_sampler.h"

#include <numeric>

#include "base/random.h"
#include "integrate/purposes.h"

namespace troffer {

namespace {

// Shadow rays are traced when so many have gathered.
constexpr size_t shadow_batch = 8192;

}  // namespace

void SourceSamplerScratch::resize(size_t n) {
  samples.resize(n);
  primitives.resize(n);
  numbers.resize(3 * n);
  pmfs.resize(n);
  u.resize(n);
  v.resize(n);
  points.resize(n);
  is_valid.resize(n);
}

SourceSampler::SourceSampler(const PreparedScene& scene) : scene_(scene) {
  for (uint32_t e = 0; e < scene.scene.lights.size(); ++e) {
    trees_.emplace_back(scene.primitives, scene.primitives.of_light(e));
    is_delta_.push_back(is_delta(scene.scene.lights[e].kind));
  }
}

// Points on the light, in the order of their numbers; those that can send no light are left out.
// Returns how many there are.
uint32_t SourceSampler::choose_points(const SampledVertex& at, uint32_t light, uint32_t n,
                                      SourceSamplerScratch& s) const {
  const Vertex& v = at.vertex;
  s.resize(n);
  s.receivers.assign(n, v.surface.position);
  s.streams.assign(n, hash_combine(at.walk.stream, light + 1));
  std::iota(s.samples.begin(), s.samples.end(), at.walk.sample * n);
  sobol_groups(s.streams.data(), s.samples.data(), n, purpose_light(at.walk.vertex), 3,
               s.numbers.data());
  uint32_t chosen = 0;
  for (uint32_t j = 0; j < n; ++j) {
    const LightChoice choice = trees_[light].choose(v.surface.position, v.geometric_normal,
                                                    at.has_transmission, s.numbers[2 * n + j]);
    if (choice.pmf == 0) continue;  // of these primitives none can send light here
    s.primitives[chosen] = choice.primitive;
    s.pmfs[chosen] = choice.pmf;
    s.u[chosen] = s.numbers[j];
    s.v[chosen] = s.numbers[n + j];
    ++chosen;
  }
  sample_many(scene_.scene, scene_.primitives, chosen, s.primitives.data(), s.receivers.data(),
              s.u.data(), s.v.data(), s.points.data(), s.is_valid.data(), s.lights);
  return chosen;
}

void SourceSampler::sample(const SampledVertex& at, uint32_t light, uint32_t n,
                           SourceSamplerScratch& s, RadianceBatch& out, Counters& counters) const {
  if (is_delta_[light]) n = 1;  // one point is all there is
  const uint32_t chosen = choose_points(at, light, n, s);
  for (uint32_t j = 0; j < chosen; ++j) {
    if (s.is_valid[j] == 0) continue;
    LightConnection c;
    Rgb carried;
    bool is_connected = false;
    if (at.alone != nullptr && connect(at.vertex, *at.alone, s.points[j], c)) {
      const float pdf_light = c.pdf_light * s.pmfs[j] * float(n);
      carried += at.walk.throughput * c.value * (1 / pdf_light);
      is_connected = true;
    }
    if (at.competing != nullptr && connect(at.vertex, *at.competing, s.points[j], c)) {
      const float pdf_light = c.pdf_light * s.pmfs[j] * float(n);
      const float weight = power_heuristic(pdf_light, c.pdf_bsdf);
      carried += at.walk.throughput * c.value * (weight / pdf_light);
      is_connected = true;
    }
    if (is_connected) s.shadows.add(c.shadow_ray, carried, at.walk.index, at.is_direct);
  }
  s.shadows.end_group(n);
  // Rays of one vertex to one source stand side by side: packets pay.
  if (s.shadows.rays.size() >= shadow_batch) resolve(s, out, counters);
}

void SourceSampler::resolve(SourceSamplerScratch& s, RadianceBatch& out, Counters& counters) const {
  s.shadows.resolve(scene_.tracer, Coherence::coherent, out, counters);
}

float SourceSampler::emission_weight(const Walk& walk, const Vertex& v, uint32_t n) const {
  const int32_t primitive = walk.pdf > 0 ? primitive_at(scene_, v.surface) : no_primitive;
  if (primitive < 0) return 1;
  return troffer::emission_weight(scene_, trees_[size_t(v.surface.light)], walk, v,
                                  uint32_t(primitive), float(n));
}

}  // namespace troffer
