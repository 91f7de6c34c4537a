#include "integrate/path.h"

#include <algorithm>
#include <new>
#include <type_traits>

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
  if (roulette_number(walk) >= survival) return false;
  walk.throughput *= 1 / survival;
  return true;
}

}  // namespace

// One wave of a batch: walks[i] stands at vertices[i], all with the same number of vertices behind
// them. Stages pass it from array to array.
struct PathIntegrator::Scratch final : IntegratorScratch {
  std::vector<Walk> walks;
  std::vector<Vertex> vertices;
  std::vector<Bsdf> bsdfs;
  WalkScratch trace;
  ShadowBatch shadows;

  std::vector<uint64_t> streams;
  std::vector<uint32_t> samples;
  std::vector<float> numbers;
  // Next-event estimation: the walks that take part, and the point each is to be connected with.
  std::vector<uint32_t> lit, primitives;
  LightReceivers receivers;
  std::vector<LightChoice> choices;
  std::vector<float> tree_scratch;
  std::vector<Vec3> points_lit;
  std::vector<float> light_u, light_v, light_pmf;
  std::vector<LightSample> points;
  std::vector<uint8_t> is_valid;
  LightSampleScratch lights;

  void resize_lights(size_t n) {
    lit.resize(n);
    primitives.resize(n);
    receivers.resize(n);
    choices.resize(n);
    points_lit.resize(n);
    for (auto* a : {&light_u, &light_v, &light_pmf}) a->resize(n);
    points.resize(n);
    is_valid.resize(n);
  }
  // Draws `dimensions` numbers per walk: number d of walk i is numbers[d * walks.size() + i].
  void draw(uint32_t purpose, int dimensions) {
    const size_t n = walks.size();
    streams.resize(n);
    samples.resize(n);
    numbers.resize(n * size_t(dimensions));
    for (size_t i = 0; i < n; ++i) {
      streams[i] = walks[i].stream;
      samples[i] = walks[i].sample;
    }
    sobol_groups(streams.data(), samples.data(), n, purpose, dimensions, numbers.data());
  }
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
  s.vertices.clear();
  s.bsdfs.clear();
  if (options_.depth == 0) return;
  for (uint32_t i = 0; i < sensors.size(); ++i) {
    s.walks.push_back(sensor_walk(sensors, i));
    s.vertices.push_back(
        make_sensor_vertex(sensors.positions[i], sensors.normals[i], sensors.offset));
    s.bsdfs.push_back(sensor_bsdf());
  }
  shade(s, out, counters);
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
    arrive(s, out);
    shade(s, out, counters);
  }
}

// From hits to vertices; keeps the walks that go on from theirs.
void PathIntegrator::arrive(Scratch& s, RadianceBatch& out) const {
  const size_t n = s.walks.size();
  s.vertices.resize(n);
  s.bsdfs.resize(n);
  size_t alive = 0;
  for (size_t i = 0; i < n; ++i) {
    const Hit& hit = s.trace.hits[i];
    if (!hit.is_valid()) continue;
    const Walk& walk = s.walks[i];
    Vertex& v = s.vertices[alive];
    make_vertex(scene_.scene, walk.ray, hit, v);
    if (v.surface.light >= 0) add_emission(walk, v, out);
    if (is_last(walk) && walk.vertex > 0) continue;
    const ColorInput& color = scene_.scene.materials[v.surface.material].base_color;
    if (color.texture >= 0) prefetch(scene_.scene.textures, uint32_t(color.texture), v.surface.uv);
    s.walks[alive++] = walk;
  }
  for (size_t i = 0; i < alive; ++i) {
    const Surface& surface = s.vertices[i].surface;
    // Made in its place: it is too large to be made and copied.
    static_assert(std::is_trivially_destructible_v<Bsdf>);
    new (&s.bsdfs[i]) Bsdf(make_bsdf(scene_.bsdf_tables, scene_.scene, surface.material, surface.uv,
                                     s.vertices[i].is_front));
    if (s.walks[i].vertex == 0) record_first_hit(s.walks[i], s.vertices[i], s.bsdfs[i], out);
  }
  if (alive > 0 && is_last(s.walks[0])) alive = 0;  // seen, but not followed
  s.walks.resize(alive);
  s.vertices.resize(alive);
  s.bsdfs.resize(alive);
}

// Next-event estimation at all vertices, then a step from each.
void PathIntegrator::shade(Scratch& s, RadianceBatch& out, Counters& counters) const {
  if (s.walks.empty()) return;
  if (!scene_.light_tree.is_empty()) {
    sample_lights(s);
    s.shadows.resolve(scene_.tracer, Coherence::none, out, counters);
  }
  step_on(s);
}

// Emission that the path runs into, weighted against next-event estimation from the vertex before.
void PathIntegrator::add_emission(const Walk& walk, const Vertex& v, RadianceBatch& out) const {
  const Rgb radiance = emission_at(scene_, v);
  if (radiance.is_black()) return;
  const int32_t primitive = walk.pdf > 0 ? primitive_at(scene_, v.surface) : no_primitive;
  const float weight =
      primitive < 0 ? 1
                    : emission_weight(scene_, scene_.light_tree, walk, v, uint32_t(primitive), 1);
  // Straight from the source: seen as it is, or scattered once with nothing in between.
  const bool is_direct = walk.scatterings == 0 || (walk.scatterings == 1 && walk.pdf > 0);
  (is_direct ? out.direct : out.indirect)[walk.index] += walk.throughput * radiance * weight;
}

void PathIntegrator::sample_lights(Scratch& s) const {
  const size_t n = s.walks.size();
  s.draw(purpose_light(s.walks[0].vertex), 3);
  s.resize_lights(n);
  size_t m = 0;
  for (uint32_t i = 0; i < n; ++i) {
    if (is_purely_delta(s.bsdfs[i])) continue;
    const Vertex& v = s.vertices[i];
    s.receivers.set(m, v.surface.position, v.geometric_normal, s.bsdfs[i].has_transmission,
                    s.numbers[2 * n + i]);
    s.lit[m++] = i;
  }
  s.receivers.resize(m);
  scene_.light_tree.choose_many(s.receivers, s.choices.data(), s.tree_scratch);
  // Those for whom there is a light close ranks.
  size_t kept = 0;
  for (size_t k = 0; k < m; ++k) {
    if (s.choices[k].pmf == 0) continue;
    const uint32_t i = s.lit[k];
    s.lit[kept] = i;
    s.primitives[kept] = s.choices[k].primitive;
    s.points_lit[kept] = s.vertices[i].surface.position;
    s.light_u[kept] = s.numbers[i];
    s.light_v[kept] = s.numbers[n + i];
    s.light_pmf[kept] = s.choices[k].pmf;
    ++kept;
  }
  m = kept;
  sample_many(scene_.primitives, m, s.primitives.data(), s.points_lit.data(), s.light_u.data(),
              s.light_v.data(), s.points.data(), s.is_valid.data(), s.lights);
  for (size_t k = 0; k < m; ++k) {
    if (s.is_valid[k] == 0) continue;
    const uint32_t i = s.lit[k];
    LightConnection c;
    if (!connect(scene_, s.vertices[i], s.bsdfs[i], scene_.primitives[s.primitives[k]], s.points[k],
                 c))
      continue;
    const float pdf_light = c.pdf_light * s.light_pmf[k];
    const float weight = power_heuristic(pdf_light, c.pdf_bsdf);
    const Walk& walk = s.walks[i];
    s.shadows.add(c.shadow_ray, walk.throughput * c.value * (weight / pdf_light), walk.index,
                  walk.scatterings == 0);
  }
}

// Sets out from every vertex; keeps the walks that do not end.
void PathIntegrator::step_on(Scratch& s) const {
  const size_t n = s.walks.size();
  s.draw(purpose_scatter(s.walks[0].vertex), 2);
  size_t alive = 0;
  for (size_t i = 0; i < n; ++i) {
    Walk& walk = s.walks[i];
    // Only surfaces with several lobes ask for the third number.
    const float lobe = is_lambertian(s.bsdfs[i], nullptr) ? 0 : lobe_number(walk);
    if (step(walk, s.vertices[i], s.bsdfs[i], lobe, {s.numbers[i], s.numbers[n + i]}) &&
        survives_roulette(walk))
      s.walks[alive++] = walk;
  }
  s.walks.resize(alive);
}

}  // namespace troffer
