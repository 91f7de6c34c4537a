#include "integrate/kj92.h"

#include <algorithm>

#include "base/error.h"
#include "base/random.h"
#include "base/warp.h"
#include "integrate/purposes.h"

namespace troffer {

namespace {

// Mirrors facing each other would reflect for ever.
constexpr uint32_t longest_chain = 64;

// Notes in Walk::last_place: a patch, or one of these.
constexpr uint32_t no_place = 0xffffffffu;  // no source was sampled there
constexpr uint32_t off_mesh = 0xfffffffeu;  // all lights were

uint64_t tree_stream(const Walk& walk) {
  return hash_combine(walk.stream, (uint64_t(walk.vertex) << 32) + walk.sample + 1);
}

}  // namespace

struct Kj92Integrator::Scratch final : IntegratorScratch {
  explicit Scratch(TreeSampler s) : sampler(std::move(s)) {}
  TreeSampler sampler;
  std::vector<Walk> walks, next_walks;
  WalkScratch trace;
  ShadowRecord record;
  std::vector<Ray> rays;
  std::vector<Hit> hits;
};

Kj92Integrator::Kj92Integrator(const PreparedScene& scene, const RadiositySolution& solution,
                               const SourceSelection& selection, const Kj92Options& options)
    : scene_(scene),
      solution_(solution),
      selection_(selection),
      radiosity_(scene, solution, selection),
      options_(options) {
  const auto lights = uint32_t(scene.scene.lights.size());
  const auto patches = uint32_t(solution.mesh.patches.size());
  index_of_source_.assign(size_t(lights) + patches, no_source);
  for (uint32_t e = 0; e < lights; ++e) {
    index_of_source_[e] = uint32_t(sources_.size());
    sources_.emplace_back(scene, e);
    everywhere_.push_back({e, {SourceView::occluded, SourceTreatment::probed, 0, 1, 0}});
  }
  for (uint32_t p = 0; p < patches; ++p)
    for (const TreatedSource& t : selection.of_patch(p)) {
      if (index_of_source_[t.source] != no_source) continue;
      index_of_source_[t.source] = uint32_t(sources_.size());
      sources_.emplace_back(scene, solution, t.source - lights);
    }
}

std::unique_ptr<IntegratorScratch> Kj92Integrator::make_scratch() const {
  return std::make_unique<Scratch>(
      TreeSampler(scene_, sources_, index_of_source_, options_.sampling));
}

std::span<const TreatedSource> Kj92Integrator::treated_at(const RadiosityPlace& place) const {
  if (place.point == no_point) return everywhere_;
  return selection_.of_patch(solution_.mesh.points[place.point].patch);
}

bool Kj92Integrator::is_treated(uint32_t place_note, uint32_t light) const {
  if (place_note == no_place) return false;
  if (place_note == off_mesh) return true;
  for (const TreatedSource& t : selection_.of_patch(place_note))
    if (t.source == light) return true;
  return false;
}

void Kj92Integrator::radiance(const ViewingRays& rays, IntegratorScratch& scratch,
                              RadianceBatch& out, Counters& counters) const {
  auto& s = static_cast<Scratch&>(scratch);
  s.sampler.forget_patterns();
  start_walks(rays, s.walks);
  counters.viewing_rays += rays.size();
  for (Walk& w : s.walks) w.last_place = no_place;
  for (Coherence c = Coherence::coherent; !s.walks.empty(); c = Coherence::none) {
    trace_walks(scene_.tracer, s.walks, c, s.trace, counters);
    s.next_walks.clear();
    CheckItems items;
    for (size_t i = 0; i < s.walks.size(); ++i) {
      const Hit& hit = s.trace.hits[i];
      if (!hit.is_valid()) continue;
      Walk& walk = s.walks[i];
      items.at(walk.index);
      Vertex v;
      make_vertex(scene_.scene, walk.ray, hit, v);
      if (v.surface.light >= 0) add_emission(walk, v, out);
      if (options_.is_direct_only && walk.scatterings > 0) continue;
      const SurfaceScattering scattering(make_bsdf(scene_.bsdf_tables, scene_.scene,
                                                   v.surface.material, v.surface.uv, v.is_front));
      if (walk.vertex == 0) record_first_hit(walk, v, scattering.whole, out);
      const NeighbourRecords* neighbours =
          walk.vertex == 0 && !rays.neighbours.empty() ? &rays.neighbours[walk.index] : nullptr;
      const bool is_lit = scattering.has_diffuse || scattering.has_rough;
      const RadiosityPlace place = is_lit ? radiosity_.place_of(hit, v) : RadiosityPlace{};
      shade(walk, place, v, scattering, neighbours, s, out, counters);
      if (scattering.has_specular && walk.vertex < longest_chain) {
        if (spawn(walk, v, scattering)) {
          walk.last_place = !scattering.has_rough     ? no_place
                            : place.point == no_point ? off_mesh
                                                      : solution_.mesh.points[place.point].patch;
          s.next_walks.push_back(walk);
        }
      }
    }
    s.walks.swap(s.next_walks);
  }
}

void Kj92Integrator::add_emission(const Walk& walk, const Vertex& v, RadianceBatch& out) const {
  const Rgb radiance = emission_at(scene_, v);
  if (radiance.is_black()) return;
  const auto light = uint32_t(v.surface.light);
  float weight = 1;
  if (walk.pdf > 0 && is_treated(walk.last_place, light)) {
    const float pdf_light = sources_[index_of_source_[light]].pdf_of_hit(scene_, walk.last_position,
                                                                         walk.ray.direction, v);
    weight = power_heuristic(walk.pdf, float(options_.sampling.tree.initial_rays) * pdf_light);
  }
  // Straight from a source: by mirrors and clear glass, or by the one rough surface it is seen in.
  const bool is_direct = walk.scatterings == 0 || (walk.scatterings == 1 && walk.pdf > 0);
  if (!is_direct && options_.is_direct_only) return;
  (is_direct ? out.direct : out.indirect)[walk.index] += walk.throughput * radiance * weight;
}

void Kj92Integrator::shade(const Walk& walk, const RadiosityPlace& place, const Vertex& v,
                           const SurfaceScattering& s, const NeighbourRecords* neighbours,
                           Scratch& scratch, RadianceBatch& out, Counters& counters) const {
  ShadowRecord* record = nullptr;
  if (walk.vertex == 0 && !out.records.empty()) {
    record = &out.records[walk.index];
    *record = {v.surface.geometry, v.is_front, v.frame.normal, v.surface.position, {}};
  }
  if (!s.has_diffuse && !s.has_rough) return;
  const bool is_direct = walk.scatterings == 0;
  Rgb direct, indirect;
  if (place.point != no_point && s.has_diffuse) {
    const GeneralIrradiance general = radiosity_.general(place);
    const Rgb reflectance = albedo(s.diffuse, v.wo.z) * inv_pi_f;
    direct += reflectance * general.direct;
    indirect += reflectance * general.indirect;
  }
  TreeReceiver receiver;
  receiver.vertex = &v;
  receiver.scattering = &s;
  receiver.stream = tree_stream(walk);
  receiver.depth = walk.vertex;
  receiver.throughput = walk.vertex == 0 ? 1 : luminance(walk.throughput);
  receiver.neighbours = neighbours;
  receiver.record = record;
  const TreeLight light = scratch.sampler.run(receiver, treated_at(place));
  direct += light.from_lights;
  indirect += light.from_patches;
  out.shadow_rays[walk.index] += light.rays;
  counters.shadow_rays += light.rays;
  counters.mixed += light.sampled;
  if (walk.vertex == 0)
    out.sources[walk.index] = {float(light.sampled), float(light.probed_visible),
                               float(light.probed_hidden)};
  (is_direct ? out.direct : out.indirect)[walk.index] += walk.throughput * direct;
  if (!options_.is_direct_only) out.indirect[walk.index] += walk.throughput * indirect;
}

bool Kj92Integrator::spawn(Walk& walk, const Vertex& v, const SurfaceScattering& s) const {
  return step(walk, v, s.specular, lobe_number(walk), direction_number(walk)) &&
         survives_spawning(walk);
}

void Kj92Integrator::irradiance(const SensorBatch& sensors, IntegratorScratch& scratch,
                                RadianceBatch& out, Counters& counters) const {
  auto& s = static_cast<Scratch&>(scratch);
  s.sampler.forget_patterns();
  const SurfaceScattering scattering(sensor_bsdf());
  s.rays.resize(sensors.size());
  CheckItems items;
  for (uint32_t i = 0; i < sensors.size(); ++i) {
    items.at(i);
    const Walk walk = sensor_walk(sensors, i);
    const Vertex v = make_sensor_vertex(sensors.positions[i], sensors.normals[i], sensors.offset);
    TreeReceiver receiver;
    receiver.vertex = &v;
    receiver.scattering = &scattering;
    receiver.stream = tree_stream(walk);
    const TreeLight light = s.sampler.run(receiver, everywhere_);
    out.direct[i] += light.from_lights;
    out.shadow_rays[i] += light.rays;
    counters.shadow_rays += light.rays;
    const Vec3 wi = v.frame.to_world(cosine_hemisphere_from_square(direction_number(walk)));
    s.rays[i] = {};
    s.rays[i].origin = offset_origin(v.surface, wi);
    s.rays[i].direction = wi;
  }
  if (options_.is_direct_only) return;
  s.hits.resize(sensors.size());
  scene_.tracer.closest(s.rays, s.hits);
  counters.extension_rays += sensors.size();
  for (uint32_t i = 0; i < sensors.size(); ++i)
    if (s.hits[i].is_valid())
      out.indirect[i] += radiosity_.radiance_seen(s.rays[i], s.hits[i]) * pi_f;
}

}  // namespace troffer
