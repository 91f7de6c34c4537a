#include "transport/light_tree_direct.h"

#include "base/random.h"
#include "transport/purposes.h"

namespace troffer {

void LightTreeDirectScratch::resize(size_t n) {
  lit.resize(n);
  primitives.resize(n);
  receivers.resize(n);
  choices.resize(n);
  points_lit.resize(n);
  for (auto* a : {&picked_u, &picked_v, &light_u, &light_v, &light_pmf}) a->resize(n);
  points.resize(n);
  is_valid.resize(n);
}

std::unique_ptr<DirectLightScratch> LightTreeDirect::make_scratch() const {
  return std::make_unique<LightTreeDirectScratch>();
}

// Lists the hit of each light sample, and the sample's random numbers. The samples of one hit
// follow each other in the sequence of its pixel.
void LightTreeDirect::set_hits(const WaveHits& wave, LightTreeDirectScratch& s) const {
  s.hits.clear();
  s.streams.clear();
  s.samples.clear();
  for (uint32_t i = 0; i < wave.size(); ++i) {
    const Walk& walk = wave.walks[i];
    const uint32_t n = samples_after(walk.scatterings);
    for (uint32_t j = 0; j < n; ++j) {
      s.hits.push_back(i);
      s.streams.push_back(walk.stream);
      s.samples.push_back(walk.sample * n + j);
    }
  }
  s.numbers.resize(3 * s.hits.size());
  sobol_groups(s.streams.data(), s.samples.data(), s.hits.size(),
               purpose_light(wave.walks[0].vertex), 3, s.numbers.data());
}

// Chooses a light for every receiver, and the numbers of the point on it.
void LightTreeDirect::choose_points(LightTreeDirectScratch& s) const {
  const LearnedLights* learned = options_.learned.get();
  if (learned == nullptr) {
    scene_.light_tree.choose_many(s.receivers, s.choices.data(), s.tree_scratch);
    return;
  }
  const LightReceivers& r = s.receivers;
  for (size_t k = 0; k < r.size(); ++k) {
    const LearnedLights::Choice c = learned->choose(r.position(k), r.normal(k), r.sides[k] != 0,
                                                    r.u[k], {s.picked_u[k], s.picked_v[k]});
    s.choices[k] = c.light;
    s.picked_u[k] = c.square.x;
    s.picked_v[k] = c.square.y;
  }
}

// Sets lit, primitives, points_lit, light_u, light_v and light_pmf for the samples that have a
// light. Returns their number.
size_t LightTreeDirect::choose_lights(const WaveHits& wave, LightTreeDirectScratch& s) const {
  set_hits(wave, s);
  const size_t n = s.hits.size();
  s.resize(n);
  size_t m = 0;
  for (size_t k = 0; k < n; ++k) {
    const uint32_t i = s.hits[k];
    if (is_purely_delta(wave.bsdfs[i])) continue;
    const Vertex& v = wave.vertices[i];
    s.receivers.set(m, v.surface.position, v.geometric_normal, wave.bsdfs[i].has_transmission,
                    s.numbers[2 * n + k]);
    s.picked_u[m] = s.numbers[k];
    s.picked_v[m] = s.numbers[n + k];
    s.lit[m++] = i;
  }
  s.receivers.resize(m);
  choose_points(s);
  // Compacts the arrays to the samples that have a light.
  size_t kept = 0;
  for (size_t k = 0; k < m; ++k) {
    if (s.choices[k].pmf == 0) continue;
    const uint32_t i = s.lit[k];
    s.lit[kept] = i;
    s.primitives[kept] = s.choices[k].primitive;
    s.points_lit[kept] = wave.vertices[i].surface.position;
    s.light_u[kept] = s.picked_u[k];
    s.light_v[kept] = s.picked_v[k];
    s.light_pmf[kept] = s.choices[k].pmf;
    ++kept;
  }
  return kept;
}

bool LightTreeDirect::has_competition(const Bsdf& bsdf) const {
  switch (options_.competition) {
    case Competition::all:
      return true;
    case Competition::none:
      return false;
    case Competition::glossy:
      break;
  }
  return !is_lambertian(bsdf, nullptr);
}

void LightTreeDirect::queue(WaveHits& wave, DirectLightScratch& scratch, RadianceBatch&,
                            Counters&) const {
  auto& s = static_cast<LightTreeDirectScratch&>(scratch);
  if (wave.size() == 0 || scene_.light_tree.is_empty()) return;
  const size_t m = choose_lights(wave, s);
  sample_many(scene_.scene, scene_.primitives, m, s.primitives.data(), s.points_lit.data(),
              s.light_u.data(), s.light_v.data(), s.points.data(), s.is_valid.data(),
              s.light_samples);
  for (size_t k = 0; k < m; ++k) {
    if (s.is_valid[k] == 0) continue;
    const uint32_t i = s.lit[k];
    LightConnection c;
    if (!connect(wave.vertices[i], wave.bsdfs[i], s.points[k], c)) continue;
    const Walk& walk = wave.walks[i];
    const float pdf_light = c.pdf_light * s.light_pmf[k] * float(samples_after(walk.scatterings));
    if (!wave.continuation_ratio.empty()) c.pdf_bsdf *= wave.continuation_ratio[i];
    const float weight =
        has_competition(wave.bsdfs[i]) ? power_heuristic(pdf_light, c.pdf_bsdf) : 1;
    s.shadows.add(c.shadow_ray, walk.throughput * c.value * (weight / pdf_light), walk.index,
                  is_direct_at(walk));
  }
}

void LightTreeDirect::flush(DirectLightScratch& scratch, RadianceBatch& out,
                            Counters& counters) const {
  static_cast<LightTreeDirectScratch&>(scratch).shadows.resolve(scene_.tracer, Coherence::coherent,
                                                                out, counters);
}

void LightTreeDirect::weigh(SeenEmission& seen) const {
  for (size_t i = 0; i < seen.size(); ++i)
    seen.weights[i] = seen.vertices[i] == nullptr
                          ? weight_of_miss(*seen.walks[i], seen.at_infinity[i])
                          : weight_of(*seen.walks[i], *seen.vertices[i]);
}

float LightTreeDirect::weight_of_miss(const Walk& walk, uint32_t primitive) const {
  const Vec3 x = walk.last_position, n = walk.last_normal;
  const float chance = options_.learned == nullptr
                           ? scene_.light_tree.pmf(x, n, walk.last_both_sides, primitive)
                           : options_.learned->pmf_at_infinity(x, n, walk.last_both_sides,
                                                               primitive, walk.ray.direction);
  return miss_weight(scene_, walk, primitive, chance * samples_before(walk));
}

float LightTreeDirect::weight_of(const Walk& walk, const Vertex& v) const {
  const int32_t primitive = primitive_at(scene_, v.surface);
  if (primitive < 0) return 1;
  float samples = samples_before(walk);
  if (options_.learned != nullptr)
    samples *= options_.learned->factor_of_placed(walk.last_position, walk.last_normal,
                                                  walk.last_both_sides);
  return emission_weight(scene_, scene_.light_tree, walk, v, uint32_t(primitive), samples);
}

}  // namespace troffer
