#include "methods/path.h"

#include <algorithm>
#include <new>
#include <type_traits>

#include "base/error.h"
#include "base/random.h"
#include "base/streams.h"
#include "gather/gather_walks.h"
#include "transport/bsdf_at.h"
#include "transport/look_through_panes.h"
#include "transport/purposes.h"
#include "transport/surface_scattering.h"
#include "transport/two_sides.h"

namespace troffer {

namespace {

// Russian roulette spares the first bounces, and paths that carry more than this share of their
// light. Measured on kj92room: noise² × rays is 40 % less than with survival = throughput.
constexpr uint32_t roulette_first_vertex = 2;
constexpr float roulette_threshold = 0.25f;
// Surfaces that absorb nothing would let a path go on for ever by its throughput alone. From this
// vertex on, at least 5 % end at each vertex.
constexpr uint32_t long_path = 32;
constexpr float long_path_survival = 0.95f;
// Paths of one wave: with their vertices they fit into the second-level cache of a core.
constexpr size_t most_at_a_time = 256;

// Ends paths that carry little and strengthens those that survive; false if the path ends. The
// random number belongs to the vertex that the path has left and is stratified over a pixel's
// samples.
bool survives_roulette(Walk& walk) {
  if (walk.vertex < roulette_first_vertex) return true;
  // Inside glass, radiance carries a factor 1/eta², which is undone when the path leaves.
  const float carried = max_component(walk.throughput) * walk.eta_squared;
  const float most = walk.vertex < long_path ? 1 : long_path_survival;
  const float survival = std::min(carried / roulette_threshold, most);
  if (survival >= 1) return true;
  if (left_vertex_number(walk) >= survival) return false;
  walk.throughput *= 1 / survival;
  return true;
}

}  // namespace

// One wave of a batch: all walks have left the same number of vertices behind. Every stage compacts
// the arrays.
struct PathIntegrator::Scratch final : IntegratorScratch {
  WaveHits wave;    // walks[i] stands at vertices[i]; `hits` is unused
  WaveHits imaged;  // vertices that a mirror image may light
  WalkScratch trace;
  LightTreeDirectScratch lights;
  ResampledDirectScratch few_lights;
  std::vector<uint64_t> streams;
  std::vector<uint32_t> samples;
  std::vector<float> numbers;

  // Draws two numbers per walk: those of walk i are numbers[i] and numbers[walks.size() + i].
  void draw_directions() {
    const std::vector<Walk>& walks = wave.walks;
    const size_t n = walks.size();
    streams.resize(n);
    samples.resize(n);
    numbers.resize(2 * n);
    for (size_t i = 0; i < n; ++i) {
      streams[i] = walks[i].stream;
      samples[i] = walks[i].sample;
    }
    sobol_groups(streams.data(), samples.data(), n, purpose_scatter(walks[0].vertex), 2,
                 numbers.data());
  }
};

std::unique_ptr<IntegratorScratch> PathIntegrator::make_scratch() const {
  return std::make_unique<Scratch>();
}

void PathIntegrator::radiance(const ViewingRays& rays, IntegratorScratch& scratch,
                              RadianceBatch& out, Counters& counters) const {
  auto& s = static_cast<Scratch&>(scratch);
  counters.viewing_rays += rays.size();
  if (options_.cells) out.enable_shared_error();
  for (size_t first = 0; first < rays.size(); first += most_at_a_time) {
    start_walks(rays, first, std::min(first + most_at_a_time, rays.size()), s.wave.walks);
    follow(s, Coherence::coherent, out, counters);
  }
}

void PathIntegrator::irradiance(const SensorBatch& sensors, IntegratorScratch& scratch,
                                RadianceBatch& out, Counters& counters) const {
  auto& s = static_cast<Scratch&>(scratch);
  if (options_.depth == 0) return;
  for (size_t first = 0; first < sensors.size(); first += most_at_a_time) {
    s.wave.clear();
    for (size_t i = first; i < std::min(first + most_at_a_time, sensors.size()); ++i) {
      s.wave.walks.push_back(sensor_walk(sensors, uint32_t(i)));
      s.wave.vertices.push_back(
          make_sensor_vertex(sensors.positions[i], sensors.normals[i], sensors.offset));
      s.wave.bsdfs.push_back(sensor_bsdf());
    }
    if (options_.leaves_out_direct_at_sensors)
      step_on(s);
    else
      shade(s, out, counters);
    follow(s, Coherence::none, out, counters);
  }
}

// True if only emission remains to be counted at the walk's next vertex.
bool PathIntegrator::is_last(const Walk& walk) const {
  return (options_.depth >= 0 && bounces(walk) >= uint32_t(options_.depth)) ||
         (options_.is_direct_only && walk.scatterings > 0);
}

void PathIntegrator::follow(Scratch& s, Coherence first, RadianceBatch& out,
                            Counters& counters) const {
  for (Coherence coherence = first; !s.wave.walks.empty(); coherence = Coherence::none) {
    trace_walks(scene_.tracer, s.wave.walks, coherence, s.trace, counters);
    arrive(s, out);
    shade(s, out, counters);
  }
}

// Turns hits into vertices and keeps the walks that continue.
void PathIntegrator::arrive(Scratch& s, RadianceBatch& out) const {
  std::vector<Walk>& walks = s.wave.walks;
  std::vector<Vertex>& vertices = s.wave.vertices;
  std::vector<Bsdf>& bsdfs = s.wave.bsdfs;
  const size_t n = walks.size();
  vertices.resize(n);
  bsdfs.resize(n);
  size_t alive = 0;
  CheckItems items;
  for (size_t i = 0; i < n; ++i) {
    const Hit& hit = s.trace.hits[i];
    Walk& walk = walks[i];
    items.at(walk.index);
    if (!hit.is_valid()) {
      add_miss(walk, out);
      continue;
    }
    Vertex& v = vertices[alive];
    arrive_at(scene_.scene, hit, walk, v);
    if (v.surface.light >= 0) add_emission(walk, v, out);
    if (is_last(walk) && walk.vertex > 0) {
      look_through_panes(scene_, walk, v, [&](const Walk& beyond, const Vertex* seen) {
        seen != nullptr ? add_emission(beyond, *seen, out) : add_miss(beyond, out);
      });
      continue;
    }
    prefetch_color(scene_.scene, v.surface);
    walks[alive++] = walk;
  }
  for (size_t i = 0; i < alive; ++i) {
    // Constructed in place: a Bsdf is too large to be made elsewhere and moved.
    static_assert(std::is_trivially_destructible_v<Bsdf>);
    new (&bsdfs[i]) Bsdf(bsdf_at(scene_, vertices[i]));
    if (walks[i].vertex == 0) record_first_hit(walks[i], vertices[i], bsdfs[i], out);
    if (has_two_sides(bsdfs[i])) choose_side(walks[i], vertices[i], bsdfs[i]);
  }
  if (options_.cells) alive = end_at_cells(s, alive, out);
  if (alive > 0 && is_last(walks[0])) alive = 0;  // recorded as first hits, but not followed
  walks.resize(alive);
  vertices.resize(alive);
  bsdfs.resize(alive);
}

// Ends the first `alive` walks where they find a cell. Returns the number of those that go on.
size_t PathIntegrator::end_at_cells(Scratch& s, size_t alive, RadianceBatch& out) const {
  size_t kept = 0;
  for (size_t i = 0; i < alive; ++i) {
    if (ends_at_cell(s.wave.walks[i], s.wave.vertices[i], s.wave.bsdfs[i], out)) continue;
    if (kept != i) {
      s.wave.walks[kept] = s.wave.walks[i];
      s.wave.vertices[kept] = s.wave.vertices[i];
      s.wave.bsdfs[kept] = s.wave.bsdfs[i];
    }
    ++kept;
  }
  return kept;
}

// Adds the light that the matte part of a surface reflects, from a cell there. Where the surface
// also has gloss, a random number decides between that light and the gloss, which the walk then
// follows: `bsdf` becomes the gloss alone.
bool PathIntegrator::ends_at_cell(Walk& walk, const Vertex& v, Bsdf& bsdf,
                                  RadianceBatch& out) const {
  // Chance of ending at a surface whose gloss has no known albedo, and its limits elsewhere.
  constexpr float even = 0.5f, least = 0.1f;
  if (walk.scatterings == 0) return false;
  const SurfaceScattering parts(bsdf);
  if (!parts.has_diffuse) return false;
  Rgb irradiance;
  float half_difference = 0;
  if (!options_.cells->irradiance_at(cell_hit_of(v, parts.diffuse),
                                     length(v.surface.position - walk.ray.origin), irradiance,
                                     half_difference))
    return false;
  const Rgb diffuse = albedo(parts.diffuse, v.wo.z);
  float chance = 1;
  if (parts.has_specular) {
    const bool is_known = !parts.specular.is_pane && !parts.specular.clear.has_lobe();
    const float matte = luminance(diffuse),
                gloss = is_known ? luminance(albedo(parts.specular, v.wo.z)) : matte;
    chance = matte + gloss > 0 ? std::clamp(matte / (matte + gloss), least, 1 - least) : even;
    const uint64_t number =
        hash_of(walk.stream, stream::end_at_cell, uint64_t{walk.sample}, uint64_t{walk.vertex});
    if (float(number >> 40) * 0x1p-24f >= chance) {
      walk.throughput *= 1 / (1 - chance);
      bsdf = parts.specular;
      return false;
    }
  }
  const Rgb weight = walk.throughput * diffuse * (inv_pi_f / chance);
  out.indirect[walk.index] += weight * irradiance;
  if (!out.drawn_error.empty())  // empty for measuring points
    out.drawn_error[walk.index] += luminance(weight) * half_difference;
  return true;
}

// Next-event estimation at all vertices, then a step from each.
void PathIntegrator::shade(Scratch& s, RadianceBatch& out, Counters& counters) const {
  if (s.wave.size() == 0) return;
  if (few_lights_) {
    few_lights_->add(s.wave, s.few_lights, out, counters);
  } else {
    tree_.queue(s.wave, s.lights, out, counters);
    tree_.flush(s.lights, out, counters);
  }
  if (!lit_images_.empty()) add_images(s, out, counters);
  step_on(s);
}

// Samples lights in mirror images, at matte vertices in front of each mirror.
void PathIntegrator::add_images(Scratch& s, RadianceBatch& out, Counters& counters) const {
  for (size_t m = 0; m < lit_images_.size(); ++m) {
    const FlatMirror& mirror = options_.images->all()[m].mirror;
    s.imaged.clear();
    for (size_t i = 0; i < s.wave.size(); ++i) {
      const Bsdf& bsdf = s.wave.bsdfs[i];
      const bool is_matte = is_lambertian(bsdf, nullptr);
      // Paths from other surfaces count what they meet in a mirror themselves, but meet no relay.
      if (!is_matte && !mirror.relayed) continue;
      if (mirror.above(s.wave.vertices[i].surface.position) <= mirror.tolerance) continue;
      const Bsdf diffuse = is_matte ? bsdf : diffuse_part(bsdf);
      if (!is_matte && !diffuse.has_separable) continue;
      s.imaged.take(s.wave, i);
      s.imaged.bsdfs.back() = diffuse;
      Walk& walk = s.imaged.walks.back();
      walk.stream = hash_of(walk.stream, stream::mirror_image_of_path, uint64_t(m));
    }
    if (s.imaged.size() == 0) continue;
    lit_images_[m].queue(s.imaged, s.lights, out, counters);
    lit_images_[m].flush(s.lights, out, counters);
  }
}

float PathIntegrator::weight_of(const Walk& walk, const Vertex& v) const {
  return few_lights_ ? few_lights_->weight_of(walk, v) : tree_.weight_of(walk, v);
}

// Adds emission that the path hits, weighted against next-event estimation from the vertex before.
void PathIntegrator::add_emission(const Walk& walk, const Vertex& v, RadianceBatch& out) const {
  const Rgb radiance = emission_at(scene_, v);
  if (radiance.is_black()) return;
  add_seen(walk, uint32_t(v.surface.light), radiance, walk.pdf > 0 ? weight_of(walk, v) : 1, out);
}

// Adds the radiance of lights at infinity, for a path that has left the scene.
void PathIntegrator::add_miss(const Walk& walk, RadianceBatch& out) const {
  for (const uint32_t p : scene_.primitives.at_infinity())
    add_seen(walk, scene_.primitives[p].light,
             radiance_at_infinity(scene_.scene, scene_.primitives[p], walk.last_position,
                                  walk.ray.direction),
             walk.pdf > 0 ? tree_.weight_of_miss(walk, p) : 1, out);
}

void PathIntegrator::add_seen(const Walk& walk, uint32_t light, Rgb radiance, float weight,
                              RadianceBatch& out) const {
  // Light is direct if the source is seen as it is, or after one scattering with nothing in
  // between.
  const bool is_direct = is_direct_at(walk) || (walk.scatterings == 1 && walk.pdf > 0);
  if (is_direct && options_.leaves_out_direct_at_sensors) return;
  if (options_.images && options_.images->is_shown(walk.last_place, light)) return;
  (is_direct ? out.direct : out.indirect)[walk.index] += walk.throughput * radiance * weight;
}

// Chooses the walk's next ray at v and notes its mirror; false if the walk ends.
bool PathIntegrator::step_from(Walk& walk, const Vertex& v, const Bsdf& bsdf,
                               const Vec2& direction) const {
  // Only surfaces with several lobes need the third number.
  const float lobe = is_lambertian(bsdf, nullptr) ? 0 : lobe_number(walk);
  const uint32_t came_from = walk.last_place, panes = walk.panes, scatterings = walk.scatterings;
  if (!step(walk, v, bsdf, lobe, direction)) return false;
  if (!options_.images || walk.panes != panes) return true;
  walk.last_place = is_lambertian(bsdf, nullptr)
                        ? MirrorImages::note_from_matte
                        : options_.images->note_beyond(
                              v, came_from, walk.scatterings != scatterings, walk.ray.direction);
  return true;
}

// Sends a walk on from every vertex and keeps those that do not end.
void PathIntegrator::step_on(Scratch& s) const {
  std::vector<Walk>& walks = s.wave.walks;
  const size_t n = walks.size();
  s.draw_directions();
  size_t alive = 0;
  CheckItems items;
  for (size_t i = 0; i < n; ++i) {
    Walk& walk = walks[i];
    items.at(walk.index);
    const Bsdf& bsdf = s.wave.bsdfs[i];
    if (step_from(walk, s.wave.vertices[i], bsdf, {s.numbers[i], s.numbers[n + i]}) &&
        survives_roulette(walk))
      walks[alive++] = walk;
  }
  walks.resize(alive);
}

}  // namespace troffer
