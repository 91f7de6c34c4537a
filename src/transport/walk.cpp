#include "transport/walk.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/random.h"
#include "transport/purposes.h"

namespace troffer {

void start_walks(const ViewingRays& rays, std::vector<Walk>& walks) {
  start_walks(rays, 0, rays.size(), walks);
}

void start_walks(const ViewingRays& rays, size_t first, size_t last, std::vector<Walk>& walks) {
  walks.assign(last - first, Walk{});
  for (size_t i = first; i < last; ++i) {
    Walk& w = walks[i - first];
    w.ray = rays.rays[i];
    w.last_position = w.ray.origin;
    w.cone = rays.cone;
    w.index = uint32_t(i);
    w.sample = rays.samples[i];
    w.stream = rays.streams[i];
  }
}

Walk sensor_walk(const SensorBatch& sensors, uint32_t i) {
  Walk w;
  w.index = i;
  w.sample = sensors.samples[i];
  w.stream = sensors.streams[i];
  return w;
}

void trace_walks(const Tracer& tracer, const std::vector<Walk>& walks, Coherence coherence,
                 WalkScratch& scratch, Counters& counters) {
  const size_t n = walks.size();
  scratch.rays.resize(n);
  scratch.hits.resize(n);
  for (size_t i = 0; i < n; ++i) scratch.rays[i] = walks[i].ray;
  const bool is_from_eye = n > 0 && walks[0].vertex == 0;
  tracer.closest(scratch.rays, scratch.hits, coherence,
                 is_from_eye ? Meeting::as_seen : Meeting::all);
  if (n > 0 && walks[0].vertex > 0) counters.extension_rays += n;
}

namespace {

bool absorbs_inside(const Material& m) {
  return !m.is_thin && !m.absorption.is_black();
}

}  // namespace

void arrive_at(const Scene& scene, const Hit& hit, Walk& walk, Vertex& v) {
  make_vertex(scene, walk.ray, hit, v, walk.cone);
  walk.cone.width += walk.cone.spread * hit.t;
  const uint32_t material = v.surface.material;
  if (!v.is_front && absorbs_inside(scene.materials[material])) walk.medium = int32_t(material);
  if (walk.medium == no_medium) return;
  const Rgb depth = scene.materials[size_t(walk.medium)].absorption * hit.t;
  walk.throughput *= Rgb{std::exp(-depth.r), std::exp(-depth.g), std::exp(-depth.b)};
}

Vec2 direction_number(const Walk& walk) {
  return SobolGroup(walk.stream, purpose_scatter(walk.vertex), walk.sample).get2(0);
}

float lobe_number(const Walk& walk) {
  return SobolGroup(walk.stream, purpose_scatter(walk.vertex), walk.sample).get(2);
}

float left_vertex_number(const Walk& walk) {
  return SobolGroup(walk.stream, purpose_scatter(walk.vertex - 1), walk.sample).get(3);
}

float side_number(const Walk& walk) {
  return SobolGroup(walk.stream, purpose_scatter(walk.vertex), walk.sample).get(4);
}

float roulette_number(const Walk& walk) {
  return SobolGroup(walk.stream, purpose_roulette(walk.vertex), walk.sample).get(0);
}

float spawning_number(const Walk& walk) {
  return SobolGroup(walk.stream, purpose_roulette(walk.vertex + 1), walk.sample).get(0);
}

bool step(Walk& walk, const Vertex& v, const Bsdf& bsdf, float lobe, const Vec2& direction) {
  BsdfSample sampled;
  if (!sample(bsdf, v.wo, lobe, direction, sampled)) return false;
  const Vec3 wi = v.frame.to_world(sampled.wi);
  if (!v.is_consistent(wi, sampled.wi)) return false;
  walk.throughput *= sampled.weight;
  if (walk.throughput.is_black()) return false;
  if (sampled.is_transmission) {
    walk.eta_squared *= sampled.eta * sampled.eta;
    if (!bsdf.is_thin || bsdf.is_absorbing)
      walk.medium = v.is_front && bsdf.is_absorbing ? int32_t(v.surface.material) : no_medium;
  }
  walk.ray = {};
  walk.ray.origin = offset_origin(v.surface, wi);
  walk.ray.direction = wi;
  if (bsdf.is_pane && sampled.is_delta && sampled.is_transmission) {
    ++walk.vertex;
    ++walk.panes;
    return true;
  }
  walk.pdf = sampled.is_delta ? 0 : sampled.pdf;
  walk.last_position = v.surface.position;
  walk.last_normal = v.geometric_normal;
  walk.last_both_sides = bsdf.has_transmission;
  ++walk.vertex;
  if (sampled.is_delta) return true;
  ++walk.scatterings;
  walk.cone = {};  // directions are random, so their mean averages over the footprint
  return true;
}

bool pass_pane(Walk& walk, const Vertex& v, const Bsdf& bsdf) {
  walk.throughput *= straight_transmittance(bsdf, v.wo);
  if (walk.throughput.is_black()) return false;
  walk.ray.origin = offset_origin(v.surface, walk.ray.direction);
  ++walk.vertex;
  ++walk.panes;
  return true;
}

bool mirror_at_pane(Walk& walk, const Vertex& v, const Bsdf& bsdf) {
  const Vec3 local{-v.wo.x, -v.wo.y, v.wo.z}, wi = v.frame.to_world(local);
  if (!v.is_consistent(wi, local)) return false;
  walk.throughput *= mirrored_reflectance(bsdf, v.wo.z);
  if (walk.throughput.is_black()) return false;
  walk.ray = {};
  walk.ray.origin = offset_origin(v.surface, wi);
  walk.ray.direction = wi;
  walk.pdf = 0;
  walk.last_position = v.surface.position;
  walk.last_normal = v.geometric_normal;
  walk.last_both_sides = bsdf.has_transmission;
  ++walk.vertex;
  return true;
}

float chance_of_spawning(const Walk& walk, const Rgb& carried, float threshold) {
  // Between white metals throughput alone would hardly ever end a walk, so 5 % of long walks end at
  // each vertex. Ending all of them would lose the light of further bounces.
  constexpr uint32_t long_walk = 24;
  constexpr float long_walk_survival = 0.95f;
  const float most = walk.vertex < long_walk ? 1 : long_walk_survival;
  return std::min(max_component(carried) * walk.eta_squared / threshold, most);
}

bool survives(Walk& walk, float chance, float number) {
  if (chance >= 1) return true;
  if (number >= chance) return false;
  walk.throughput *= 1 / chance;
  return true;
}

bool survives_spawning(Walk& walk) {
  constexpr float threshold = 0.1f;
  const float chance = chance_of_spawning(walk, walk.throughput, threshold);
  return chance >= 1 || survives(walk, chance, roulette_number(walk));
}

void record_first_hit(const Walk& walk, const Vertex& v, const Bsdf& bsdf, RadianceBatch& out) {
  out.albedo[walk.index] = albedo(bsdf, v.wo.z);
  out.normal[walk.index] = v.frame.normal;
  out.position[walk.index] = v.surface.position;
  out.is_hit[walk.index] = 1;
  if (!out.records.empty())
    out.records[walk.index] = {
        v.surface.geometry, v.is_front, v.frame.normal, v.surface.position, {}};
}

float emission_weight(const PreparedScene& scene, const LightTree& tree, const Walk& walk,
                      const Vertex& v, uint32_t primitive, float samples) {
  const float pmf = tree.pmf(walk.last_position, walk.last_normal, walk.last_both_sides, primitive);
  const float pdf_light = pmf * pdf_of_hit(scene, scene.primitives[primitive], walk.last_position,
                                           walk.ray.direction, v);
  return power_heuristic(walk.pdf, samples * pdf_light);
}

float miss_weight(const PreparedScene& scene, const Walk& walk, uint32_t primitive, float samples) {
  const float pdf_light =
      pdf_solid_angle(scene.scene, scene.primitives[primitive], walk.last_position,
                      walk.ray.direction, std::numeric_limits<float>::infinity());
  return power_heuristic(walk.pdf, samples * pdf_light);
}

void ShadowBatch::add(const Ray& ray, Rgb contribution, uint32_t index, bool direct) {
  rays.push_back(ray);
  contributions.push_back(contribution);
  indices.push_back(index);
  is_direct.push_back(direct ? 1 : 0);
}

// Adds the variance of each group to direct_variance. It is that of a mean of independent points,
// an upper bound for stratified ones.
void ShadowBatch::add_variance(RadianceBatch& out) const {
  size_t i = 0;
  for (const Group& g : groups) {
    float sum = 0, squares = 0;
    const size_t first = i;
    for (; i < g.end; ++i) {
      const float y = is_occluded[i] != 0 ? 0.0f : luminance(contributions[i]);
      sum += y;
      squares += y * y;
    }
    if (first == g.end || is_direct[first] == 0) continue;
    const auto n = float(g.points);
    const float spread = std::max(squares - sum * sum / n, 0.0f);
    out.direct_variance[indices[first]] += n > 1 ? spread * n / (n - 1) : squares;
  }
}

void ShadowBatch::resolve(const Tracer& tracer, Coherence coherence, RadianceBatch& out,
                          Counters& counters) {
  is_occluded.resize(rays.size());
  tracer.occluded(rays, is_occluded, coherence, factors);
  for (size_t i = 0; i < rays.size(); ++i) {
    ++out.shadow_rays[indices[i]];
    if (is_occluded[i] != 0) continue;
    contributions[i] *= factors[i];
    (is_direct[i] != 0 ? out.direct : out.indirect)[indices[i]] += contributions[i];
  }
  if (!out.direct_variance.empty()) add_variance(out);
  groups.clear();
  counters.shadow_rays += rays.size();
  rays.clear();
  contributions.clear();
  indices.clear();
  is_direct.clear();
}

}  // namespace troffer
