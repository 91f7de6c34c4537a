#include "transport/wave_integrator.h"

#include <algorithm>
#include <deque>

#include "base/error.h"
#include "transport/bsdf_at.h"
#include "transport/look_through_panes.h"
#include "transport/two_sides.h"

namespace troffer {

namespace {

// Limit for walks without Russian roulette: facing mirrors would reflect forever.
constexpr uint32_t longest_chain = 64;
constexpr uint32_t most_divisions = 3;  // splits of a viewing ray at successive panes
// Hits that a method gets at a time, few enough for their data to stay in the caches.
constexpr size_t hits_at_a_time = 64;

// The far side of a diffusely transmitting surface that was hit.
struct FarSide {
  FarSide(const Walk& w, const Hit& h) : walk(w), hit(h) {}
  Walk walk;
  Hit hit;
  Vertex vertex;
  Bsdf bsdf;
};

}  // namespace

struct WaveIntegrator::Scratch final : IntegratorScratch {
  std::unique_ptr<DirectLightScratch> direct;
  std::unique_ptr<IndirectLightScratch> indirect;  // null if there is no indirect light
  std::vector<Walk> walks, next_walks;
  WalkScratch trace;
  WaveHits wave;
  std::vector<FarSide> far;
  SeenEmission seen;       // emission in competition with the sampling of sources
  SeenEmission undivided;  // emission without competition
  // Storage for walks and vertices behind panes that seen and undivided point to.
  std::deque<Walk> beyond_walks;
  std::deque<Vertex> beyond;
};

WaveIntegrator::WaveIntegrator(const PreparedScene& scene, std::unique_ptr<DirectLight> direct,
                               std::unique_ptr<IndirectLight> indirect, bool has_surrogates,
                               std::unique_ptr<const Integrator> cheaper)
    : scene_(scene),
      direct_(std::move(direct)),
      indirect_(std::move(indirect)),
      has_surrogates_(has_surrogates),
      cheaper_(std::move(cheaper)) {
  TROFFER_CHECK(!indirect_ || direct_->walked_part() == WalkedPart::specular);
}

std::unique_ptr<IntegratorScratch> WaveIntegrator::make_scratch() const {
  auto s = std::make_unique<Scratch>();
  s->direct = direct_->make_scratch();
  if (indirect_) s->indirect = indirect_->make_scratch();
  return s;
}

void WaveIntegrator::begin(const SampleRequest& request, Scratch& s, RadianceBatch& out) const {
  direct_->begin(request, *s.direct);
  if (indirect_) indirect_->begin(request, *s.indirect);
  if (direct_->estimates_variance()) out.enable_variance();
  // Direct variance then covers all light.
  if (!indirect_ && has_surrogates_) out.luminance_with_error.assign(out.direct.size(), 0);
}

void WaveIntegrator::flush(Scratch& s, RadianceBatch& out, Counters& counters) const {
  direct_->flush(*s.direct, out, counters);
  if (indirect_) indirect_->flush(*s.indirect, out, counters);
}

void WaveIntegrator::radiance(const ViewingRays& rays, IntegratorScratch& scratch,
                              RadianceBatch& out, Counters& counters) const {
  auto& s = static_cast<Scratch&>(scratch);
  begin(rays.request, s, out);
  start_walks(rays, s.walks);
  counters.viewing_rays += rays.size();
  for (Coherence c = Coherence::coherent; !s.walks.empty(); c = Coherence::none) {
    trace_walks(scene_.tracer, s.walks, c, s.trace, counters);
    s.next_walks.clear();
    for (size_t first = 0; first < s.walks.size(); first += hits_at_a_time) {
      arrive(first, std::min(first + hits_at_a_time, s.walks.size()), s, out);
      s.wave.viewing = &rays;
      scatter(s, out);
      if (s.wave.size() == 0) continue;
      if (indirect_ && !out.known.empty() && c == Coherence::coherent) indirect_->know(s.wave, out);
      direct_->queue(s.wave, *s.direct, out, counters);
      if (indirect_) indirect_->queue(s.wave, *s.indirect, out, counters);
      step_on(s);
    }
    flush(s, out, counters);
    s.walks.swap(s.next_walks);
  }
}

// Traces viewing rays like radiance(), but only looks up known light at first hits.
void WaveIntegrator::surrogate_radiance(const ViewingRays& rays, IntegratorScratch& scratch,
                                        RadianceBatch& out, Counters& counters) const {
  auto& s = static_cast<Scratch&>(scratch);
  start_walks(rays, s.walks);
  counters.surrogates += rays.size();
  trace_walks(scene_.tracer, s.walks, Coherence::coherent, s.trace, counters);
  for (size_t first = 0; first < s.walks.size(); first += hits_at_a_time) {
    arrive(first, std::min(first + hits_at_a_time, s.walks.size()), s, out);
    s.wave.viewing = &rays;
    scatter(s, out);
    if (indirect_) indirect_->know(s.wave, out);
  }
}

void WaveIntegrator::irradiance(const SensorBatch& sensors, IntegratorScratch& scratch,
                                RadianceBatch& out, Counters& counters) const {
  auto& s = static_cast<Scratch&>(scratch);
  begin({}, s, out);
  const bool is_whole = direct_->walked_part() == WalkedPart::whole;
  const auto n = uint32_t(sensors.size());
  WaveHits& w = s.wave;
  for (uint32_t i = 0; i < n;) {
    w.clear();
    for (; i < n && w.walks.size() < hits_at_a_time; ++i) {
      if (sensors.samples[i] % sensors.samples_per_direct != 0) continue;
      Walk& walk = w.walks.emplace_back(sensor_walk(sensors, i));
      walk.sample /= sensors.samples_per_direct;
      w.vertices.push_back(
          make_sensor_vertex(sensors.positions[i], sensors.normals[i], sensors.offset));
      if (is_whole)
        w.bsdfs.push_back(sensor_bsdf());
      else
        w.scatterings.emplace_back(sensor_bsdf());
    }
    direct_->queue(w, *s.direct, out, counters);
  }
  direct_->flush(*s.direct, out, counters);
  if (sensors.samples_per_direct > 1) {
    for (uint32_t i = 0; i < n; ++i) {
      out.direct[i] *= float(sensors.samples_per_direct);
      out.indirect[i] *= float(sensors.samples_per_direct);
    }
    out.images = out.indirect;
  }
  if (indirect_) indirect_->gather(sensors, *s.indirect, out, counters);
}

// Computes the vertices of some walks' hits, and adds the emission that they meet to `out`.
void WaveIntegrator::arrive(size_t first, size_t last, Scratch& s, RadianceBatch& out) const {
  WaveHits& w = s.wave;
  w.clear();
  w.walks.reserve(hits_at_a_time);
  w.vertices.reserve(hits_at_a_time);
  s.seen.clear();
  s.undivided.clear();
  s.beyond_walks.clear();
  s.beyond.clear();
  CheckItems items;
  for (size_t i = first; i < last; ++i) {
    const Hit& hit = s.trace.hits[i];
    items.at(s.walks[i].index);
    if (!hit.is_valid()) {
      see_lights_at_infinity(s.walks[i], s);
      continue;
    }
    Walk& walk = w.walks.emplace_back(s.walks[i]);
    w.hits.push_back(hit);
    Vertex& v = w.vertices.emplace_back();
    arrive_at(scene_.scene, hit, walk, v);
    if (v.surface.light >= 0) {
      const Rgb radiance = emission_at(scene_, v);
      if (!radiance.is_black()) (walk.pdf > 0 ? s.seen : s.undivided).add(walk, &v, radiance);
    }
    if (ends_here(walk) && scene_.tracer.has_panes()) see_through_panes(walk, v, s);
  }
  add_emission(s, out);
}

// Records emission behind panes for a walk that ends at v.
void WaveIntegrator::see_through_panes(const Walk& walk, const Vertex& v, Scratch& s) const {
  look_through_panes(scene_, walk, v, [&](const Walk& beyond, const Vertex* seen) {
    const Walk& kept = s.beyond_walks.emplace_back(beyond);
    if (seen == nullptr) {
      see_lights_at_infinity(kept, s);
      return;
    }
    const Rgb radiance = seen->surface.light >= 0 ? emission_at(scene_, *seen) : Rgb{0};
    if (!radiance.is_black())
      (kept.pdf > 0 ? s.seen : s.undivided).add(kept, &s.beyond.emplace_back(*seen), radiance);
  });
}

void WaveIntegrator::see_lights_at_infinity(const Walk& walk, Scratch& s) const {
  for (const uint32_t p : scene_.primitives.at_infinity()) {
    const Rgb radiance = radiance_at_infinity(scene_.scene, scene_.primitives[p],
                                              walk.last_position, walk.ray.direction);
    if (!radiance.is_black()) (walk.pdf > 0 ? s.seen : s.undivided).add(walk, nullptr, radiance, p);
  }
}

void WaveIntegrator::add_emission(Scratch& s, RadianceBatch& out) const {
  if (s.seen.size() > 0) direct_->weigh(s.seen);
  for (const SeenEmission* seen : {&s.undivided, &s.seen})
    for (size_t i = 0; i < seen->size(); ++i) {
      const Walk& walk = *seen->walks[i];
      // Emission counts as direct if at most one rough surface scattered the walk, and that vertex
      // sampled sources.
      const bool is_direct = is_direct_at(walk) || (walk.scatterings == 1 && walk.pdf > 0);
      if (!is_direct && !indirect_) continue;
      const Rgb light = walk.throughput * seen->radiance[i] * seen->weights[i];
      if (!out.known.empty() && walk.vertex == 0) out.known[walk.index].direct += light;
      out.add(walk.index, is_direct, light, 0);
      if (is_direct && walk.pdf > 0) out.exclude_from_error(walk.index, luminance(light));
    }
}

// Keeps the hits at which light is computed, and their BSDFs.
void WaveIntegrator::scatter(Scratch& s, RadianceBatch& out) const {
  WaveHits& w = s.wave;
  const bool is_whole = direct_->walked_part() == WalkedPart::whole;
  // Gather records are per pixel.
  const bool gathers_gloss = indirect_ && indirect_->gathers_gloss() && !w.viewing->pixels.empty();
  const auto add_parts = [&](const Walk& walk, const SurfaceScattering& parts, float cosine) {
    SurfaceScattering& scattering = w.scatterings.emplace_back(parts);
    if (walk.scatterings == 0 && gathers_gloss && scattering.is_wide())
      scattering.gather_gloss(cosine);
  };
  size_t kept = 0;
  s.far.clear();
  CheckItems items;
  for (size_t i = 0; i < w.size(); ++i) {
    const Walk& walk = w.walks[i];
    if (ends_here(walk)) continue;
    items.at(walk.index);
    if (kept != i) {
      w.walks[kept] = walk;
      w.hits[kept] = w.hits[i];
      w.vertices[kept] = w.vertices[i];
    }
    const Vertex& v = w.vertices[kept];
    ScatteringAt at(scene_, v);
    if (w.walks[kept].vertex == 0) record_first_hit(w.walks[kept], v, at.whole(), out);
    if (has_two_sides(at.whole())) {
      FarSide& far = s.far.emplace_back(w.walks[kept], w.hits[kept]);
      far.bsdf = take_far_side(v, at.of_two_sides(), far.walk, far.vertex);
    }
    if (is_whole)
      w.bsdfs.push_back(at.whole());
    else
      add_parts(w.walks[kept], at.in_parts(), v.wo.z);
    ++kept;
  }
  w.walks.resize(kept);
  w.hits.resize(kept);
  w.vertices.resize(kept);
  for (const FarSide& far : s.far) {
    w.walks.push_back(far.walk);
    w.hits.push_back(far.hit);
    w.vertices.push_back(far.vertex);
    if (is_whole)
      w.bsdfs.push_back(far.bsdf);
    else
      add_parts(far.walk, SurfaceScattering(far.bsdf), far.vertex.wo.z);
  }
}

// Sends the walks on to the next wave. At the first few panes a walk is split into the transmitted
// and the reflected part. The view through a window then has no noise from the choice between them.
void WaveIntegrator::step_on(Scratch& s) const {
  const bool is_whole = direct_->walked_part() == WalkedPart::whole;
  CheckItems items;
  for (size_t i = 0; i < s.wave.size(); ++i) {
    Walk& walk = s.wave.walks[i];
    items.at(walk.index);
    if (is_whole && walk.vertex >= longest_chain) continue;
    const Vertex& v = s.wave.vertices[i];
    const Bsdf& sent = is_whole ? s.wave.bsdfs[i] : s.wave.scatterings[i].specular;
    if (sent.is_pane && walk.vertex < most_divisions && has_one_mirror(sent)) {
      Walk mirrored = walk;
      if (pass_pane(walk, v, sent)) s.next_walks.push_back(walk);
      if (mirror_at_pane(mirrored, v, sent)) s.next_walks.push_back(mirrored);
      continue;
    }
    if (is_whole) {
      const Bsdf& bsdf = sent;
      if (!is_lambertian(bsdf, nullptr) &&
          step(walk, v, bsdf, lobe_number(walk), direction_number(walk)))
        s.next_walks.push_back(walk);
    } else if (const SurfaceScattering& scattering = s.wave.scatterings[i];
               scattering.has_specular &&
               step(walk, v, scattering.specular, lobe_number(walk), direction_number(walk)) &&
               survives_spawning(walk)) {
      walk.is_last = scattering.is_gathered;
      s.next_walks.push_back(walk);
    }
  }
}

}  // namespace troffer
