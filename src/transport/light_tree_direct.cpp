#include "transport/light_tree_direct.h"

#include <algorithm>
#include <limits>

#include "base/random.h"
#include "base/units.h"
#include "transport/purposes.h"

namespace troffer {

void LightTreeDirectScratch::resize(size_t n) {
  lit.resize(n);
  primitives.resize(n);
  receivers.resize(n);
  by_openings.assign(n, -1);
  pdf_of_openings.assign(n, 0);
  choices.resize(n);
  points_lit.resize(n);
  for (auto* a : {&light_u, &light_v, &light_pmf}) a->resize(n);
  points.resize(n);
  is_valid.resize(n);
}

std::unique_ptr<DirectLightScratch> LightTreeDirect::make_scratch() const {
  return std::make_unique<LightTreeDirectScratch>();
}

// Decides by the number of each receiver in the box whether openings or the tree choose.
void LightTreeDirect::share_numbers(LightTreeDirectScratch& s) const {
  if (!openings_) return;
  for (size_t k = 0; k < s.receivers.size(); ++k) {
    if (!openings_->contains(s.receivers.position(k))) continue;
    float& u = s.receivers.u[k];
    if (u < Openings::share)
      s.by_openings[k] = u / Openings::share;
    else
      u = std::min((u - Openings::share) / (1 - Openings::share), one_minus_epsilon);
  }
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
  share_numbers(s);
  scene_.light_tree.choose_many(s.receivers, s.choices.data(), s.tree_scratch);
  // Compacts the arrays to the hits that have a light.
  size_t kept = 0;
  for (size_t k = 0; k < m; ++k) {
    const uint32_t i = s.lit[k];
    LightChoice choice = s.choices[k];
    if (s.by_openings[k] >= 0) {
      const Vec3 x = s.receivers.position(k), n_k = s.receivers.normal(k);
      choice.primitive = openings_->piece();
      choice.pmf = scene_.light_tree.pmf(x, n_k, s.receivers.sides[k] != 0, choice.primitive);
    }
    if (choice.pmf == 0) continue;
    s.lit[kept] = i;
    s.by_openings[kept] = s.by_openings[k];
    s.primitives[kept] = choice.primitive;
    s.points_lit[kept] = wave.vertices[i].surface.position;
    s.light_u[kept] = s.numbers[i];
    s.light_v[kept] = s.numbers[n + i];
    s.light_pmf[kept] = choice.pmf;
    ++kept;
  }
  return kept;
}

// Replaces the points that openings choose, and sets the densities of the mixture at receivers in
// the box.
void LightTreeDirect::sample_openings(const WaveHits& wave, size_t points,
                                      LightTreeDirectScratch& s) const {
  if (!openings_) return;
  for (size_t k = 0; k < points; ++k) {
    const uint32_t i = s.lit[k];
    const Vec3 x = s.points_lit[k], n = wave.vertices[i].geometric_normal;
    const bool both_sides = wave.bsdfs[i].has_transmission;
    if (!openings_->contains(x)) continue;
    s.light_pmf[k] *= 1 - Openings::share;
    if (s.primitives[k] != openings_->piece()) continue;
    if (s.by_openings[k] >= 0) {
      Vec3 wi;
      s.is_valid[k] =
          openings_->sample(x, n, both_sides, s.by_openings[k], {s.light_u[k], s.light_v[k]}, wi);
      if (s.is_valid[k] == 0) continue;
      sample_towards(scene_.scene, scene_.primitives[s.primitives[k]], wi, s.points[k]);
    }
    if (s.is_valid[k] == 0) continue;
    s.pdf_of_openings[k] = Openings::share * openings_->pdf(x, n, both_sides, s.points[k].wi);
    // Rounding may move a direction at the edge of an opening out of it.
    if (s.by_openings[k] >= 0 && !(s.pdf_of_openings[k] > 0)) s.is_valid[k] = 0;
  }
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
  sample_openings(wave, m, s);
  for (size_t k = 0; k < m; ++k) {
    if (s.is_valid[k] == 0) continue;
    const uint32_t i = s.lit[k];
    LightConnection c;
    if (!connect(wave.vertices[i], wave.bsdfs[i], s.points[k], c)) continue;
    const float pdf_light = c.pdf_light * s.light_pmf[k] + s.pdf_of_openings[k];
    if (!wave.continuation_ratio.empty()) c.pdf_bsdf *= wave.continuation_ratio[i];
    const float weight =
        has_competition(wave.bsdfs[i]) ? power_heuristic(pdf_light, c.pdf_bsdf) : 1;
    const Walk& walk = wave.walks[i];
    if (s.record != nullptr && s.primitives[k] == s.recorded) {
      s.record->push_back({wave.vertices[i].surface.position, s.points[k].wi, 1 / pdf_light,
                           luminance(s.points[k].radiance)});
      s.ray_of_record.push_back(uint32_t(s.shadows.rays.size()));
    }
    s.shadows.add(c.shadow_ray, walk.throughput * c.value * (weight / pdf_light), walk.index,
                  is_direct_at(walk));
  }
}

void LightTreeDirect::flush(DirectLightScratch& scratch, RadianceBatch& out,
                            Counters& counters) const {
  auto& s = static_cast<LightTreeDirectScratch&>(scratch);
  s.shadows.resolve(scene_.tracer, Coherence::coherent, out, counters);
  const size_t recorded = s.ray_of_record.size();
  for (size_t r = 0; r < recorded; ++r) {
    const uint32_t ray = s.ray_of_record[r];
    (*s.record)[s.record->size() - recorded + r].light *=
        s.shadows.is_occluded[ray] != 0 ? 0 : luminance(s.shadows.factors[ray]);
  }
  s.ray_of_record.clear();
}

// Probability with which the tree has chosen a piece at the vertex that the walk comes from.
float LightTreeDirect::pmf_at(const Walk& walk, uint32_t primitive) const {
  const float pmf =
      scene_.light_tree.pmf(walk.last_position, walk.last_normal, walk.last_both_sides, primitive);
  const bool is_shared = openings_ && openings_->contains(walk.last_position);
  return is_shared ? pmf * (1 - Openings::share) : pmf;
}

void LightTreeDirect::weigh(SeenEmission& seen) const {
  for (size_t i = 0; i < seen.size(); ++i)
    seen.weights[i] = seen.vertices[i] == nullptr
                          ? weight_of_miss(*seen.walks[i], seen.at_infinity[i])
                          : weight_of(*seen.walks[i], *seen.vertices[i]);
}

float LightTreeDirect::weight_of_miss(const Walk& walk, uint32_t primitive) const {
  float pdf = pmf_at(walk, primitive) * pdf_solid_angle(scene_.scene, scene_.primitives[primitive],
                                                        walk.last_position, walk.ray.direction,
                                                        std::numeric_limits<float>::infinity());
  if (openings_ && primitive == openings_->piece() && openings_->contains(walk.last_position))
    pdf += Openings::share * openings_->pdf(walk.last_position, walk.last_normal,
                                            walk.last_both_sides, walk.ray.direction);
  return power_heuristic(walk.pdf, pdf);
}

float LightTreeDirect::weight_of(const Walk& walk, const Vertex& v) const {
  const int32_t primitive = primitive_at(scene_, v.surface);
  if (primitive < 0) return 1;
  return power_heuristic(walk.pdf, pmf_at(walk, uint32_t(primitive)) *
                                       pdf_of_hit(scene_, scene_.primitives[size_t(primitive)],
                                                  walk.last_position, walk.ray.direction, v));
}

}  // namespace troffer
