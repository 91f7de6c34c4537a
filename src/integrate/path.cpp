#include "integrate/path.h"

#include <algorithm>

#include "base/random.h"
#include "integrate/purposes.h"

namespace troffer {

namespace {

// Russian roulette leaves the first bounces alone, and paths that still carry more than this share
// of their light. Measured on kj92room: noise² × rays is 40 % less than with survival = throughput.
constexpr uint32_t roulette_first_vertex = 2;
constexpr float roulette_threshold = 0.25f;
// Where surfaces absorb nothing, throughput alone would never end a path: from this vertex on some
// 5 % end all the same.
constexpr uint32_t long_path = 32;
constexpr float long_path_survival = 0.95f;

// Ends paths that carry little, and strengthens those that survive; false where it ends.
bool survives_roulette(Walk& walk) {
  if (walk.vertex < roulette_first_vertex) return true;
  // The factor 1/eta² of radiance inside glass comes back when the path leaves it.
  const float carried = max_component(walk.throughput) * walk.eta_squared;
  const float most = walk.vertex < long_path ? 1 : long_path_survival;
  const float survival = std::min(carried / roulette_threshold, most);
  if (survival >= 1) return true;
  const SobolGroup random(walk.stream, purpose_scatter(walk.vertex - 1), walk.sample);
  if (random.get(3) >= survival) return false;
  walk.throughput *= 1 / survival;
  return true;
}

}  // namespace

struct PathIntegrator::Scratch final : IntegratorScratch {
  std::vector<Walk> walks;
  WalkScratch trace;
  ShadowBatch shadows;
};

std::unique_ptr<IntegratorScratch> PathIntegrator::make_scratch() const {
  return std::make_unique<Scratch>();
}

void PathIntegrator::radiance(const ViewingRays& rays, IntegratorScratch& scratch,
                              RadianceBatch& out, Counters& counters) const {
  auto& s = static_cast<Scratch&>(scratch);
  start_walks(rays, s.walks);
  counters.viewing_rays += rays.size();
  follow(s, Coherence::coherent, out, counters);
}

void PathIntegrator::irradiance(const SensorBatch& sensors, IntegratorScratch& scratch,
                                RadianceBatch& out, Counters& counters) const {
  auto& s = static_cast<Scratch&>(scratch);
  s.walks.clear();
  if (options_.depth == 0) return;
  for (uint32_t i = 0; i < sensors.size(); ++i) {
    Walk walk = sensor_walk(sensors, i);
    const Vertex v = make_sensor_vertex(sensors.positions[i], sensors.normals[i], sensors.offset);
    if (shade(walk, v, sensor_bsdf(), s)) s.walks.push_back(walk);
  }
  s.shadows.resolve(scene_.tracer, Coherence::none, out, counters);
  follow(s, Coherence::none, out, counters);
}

// True where only emission is still to be gathered.
bool PathIntegrator::is_last(const Walk& walk) const {
  return (options_.depth >= 0 && walk.vertex >= uint32_t(options_.depth)) ||
         (options_.is_direct_only && walk.scatterings > 0);
}

void PathIntegrator::follow(Scratch& s, Coherence first, RadianceBatch& out,
                            Counters& counters) const {
  for (Coherence coherence = first; !s.walks.empty(); coherence = Coherence::none) {
    trace_walks(scene_.tracer, s.walks, coherence, s.trace, counters);
    size_t alive = 0;
    for (size_t i = 0; i < s.walks.size(); ++i) {
      const Hit& hit = s.trace.hits[i];
      if (!hit.is_valid()) continue;
      Walk& walk = s.walks[i];
      const Vertex v = make_vertex(surface_at(scene_.scene, walk.ray, hit), walk.ray.direction);
      if (v.surface.emitter >= 0) add_emission(walk, v, out);
      const bool goes_on = !is_last(walk);
      if (!goes_on && walk.vertex > 0) continue;
      const Bsdf bsdf =
          make_bsdf(scene_.bsdf_tables, scene_.scene, v.surface.material, v.surface.uv, v.is_front);
      if (walk.vertex == 0) record_first_hit(walk, v, bsdf, out);
      if (goes_on && shade(walk, v, bsdf, s)) s.walks[alive++] = walk;
    }
    s.walks.resize(alive);
    s.shadows.resolve(scene_.tracer, Coherence::none, out, counters);
  }
}

// Emission that the path runs into, weighted against next-event estimation from the vertex before.
void PathIntegrator::add_emission(const Walk& walk, const Vertex& v, RadianceBatch& out) const {
  const Rgb radiance = emission_at(scene_, v);
  if (radiance.is_black()) return;
  const int32_t primitive = walk.pdf > 0 ? primitive_at(scene_, v.surface) : no_primitive;
  const float weight =
      primitive < 0 ? 1
                    : emission_weight(scene_, scene_.light_tree, walk, v, uint32_t(primitive), 1);
  (walk.scatterings <= 1 ? out.direct : out.indirect)[walk.index] +=
      walk.throughput * radiance * weight;
}

void PathIntegrator::sample_light(const Walk& walk, const Vertex& v, const Bsdf& bsdf,
                                  Scratch& s) const {
  const SobolGroup random(walk.stream, purpose_light(walk.vertex), walk.sample);
  const LightChoice choice = scene_.light_tree.choose(v.surface.position, v.geometric_normal,
                                                      bsdf.has_transmission, random.get(2));
  if (choice.pmf == 0) return;
  LightConnection c;
  if (!connect(scene_, v, bsdf, scene_.lights[choice.primitive], random.get2(), c)) return;
  const float pdf_light = c.pdf_light * choice.pmf;
  const float weight = power_heuristic(pdf_light, c.pdf_bsdf);
  s.shadows.add(c.shadow_ray, walk.throughput * c.value * (weight / pdf_light), walk.index,
                walk.scatterings == 0);
}

// Next-event estimation at a vertex, then on to the next; false where the path ends.
bool PathIntegrator::shade(Walk& walk, const Vertex& v, const Bsdf& bsdf, Scratch& s) const {
  if (!scene_.light_tree.is_empty() && !is_purely_delta(bsdf)) sample_light(walk, v, bsdf, s);
  return step(walk, v, bsdf) && survives_roulette(walk);
}

}  // namespace troffer
