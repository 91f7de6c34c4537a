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
  for (auto* a : {&light_u, &light_v, &light_pmf}) a->resize(n);
  points.resize(n);
  is_valid.resize(n);
}

std::unique_ptr<DirectLightScratch> LightTreeDirect::make_scratch() const {
  return std::make_unique<LightTreeDirectScratch>();
}

// Sets lit, primitives, points_lit, light_u, light_v and light_pmf for the hits that have a light.
// Returns their number.
size_t LightTreeDirect::choose_lights(const WaveHits& wave, LightTreeDirectScratch& s) const {
  const size_t n = wave.size();
  s.streams.resize(n);
  s.samples.resize(n);
  s.numbers.resize(3 * n);
  for (size_t i = 0; i < n; ++i) {
    s.streams[i] = wave.walks[i].stream;
    s.samples[i] = wave.walks[i].sample;
  }
  sobol_groups(s.streams.data(), s.samples.data(), n, purpose_light(wave.walks[0].vertex), 3,
               s.numbers.data());
  s.resize(n);
  size_t m = 0;
  for (uint32_t i = 0; i < n; ++i) {
    if (is_purely_delta(wave.bsdfs[i])) continue;
    const Vertex& v = wave.vertices[i];
    s.receivers.set(m, v.surface.position, v.geometric_normal, wave.bsdfs[i].has_transmission,
                    s.numbers[2 * n + i]);
    s.lit[m++] = i;
  }
  s.receivers.resize(m);
  scene_.light_tree.choose_many(s.receivers, s.choices.data(), s.tree_scratch);
  // Compacts the arrays to the hits that have a light.
  size_t kept = 0;
  for (size_t k = 0; k < m; ++k) {
    if (s.choices[k].pmf == 0) continue;
    const uint32_t i = s.lit[k];
    s.lit[kept] = i;
    s.primitives[kept] = s.choices[k].primitive;
    s.points_lit[kept] = wave.vertices[i].surface.position;
    s.light_u[kept] = s.numbers[i];
    s.light_v[kept] = s.numbers[n + i];
    s.light_pmf[kept] = s.choices[k].pmf;
    ++kept;
  }
  return kept;
}

bool LightTreeDirect::has_competition(const Bsdf& bsdf) const {
  switch (competition_) {
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
    const float pdf_light = c.pdf_light * s.light_pmf[k];
    if (!wave.continuation_ratio.empty()) c.pdf_bsdf *= wave.continuation_ratio[i];
    const float weight =
        has_competition(wave.bsdfs[i]) ? power_heuristic(pdf_light, c.pdf_bsdf) : 1;
    const Walk& walk = wave.walks[i];
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
  return miss_weight(
      scene_, walk, primitive,
      scene_.light_tree.pmf(walk.last_position, walk.last_normal, walk.last_both_sides, primitive));
}

float LightTreeDirect::weight_of(const Walk& walk, const Vertex& v) const {
  const int32_t primitive = primitive_at(scene_, v.surface);
  return primitive < 0
             ? 1
             : emission_weight(scene_, scene_.light_tree, walk, v, uint32_t(primitive), 1);
}

}  // namespace troffer
