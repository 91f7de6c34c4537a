#include "kj92/bintree_direct.h"

#include "base/error.h"
#include "base/random.h"

namespace troffer {

namespace {

// Values of Walk::last_place: a patch, or one of these.
constexpr uint32_t no_place = 0xffffffffu;  // no source was sampled there
constexpr uint32_t off_mesh = 0xfffffffeu;  // all lights were sampled there

uint64_t tree_stream(const Walk& walk) {
  return hash_combine(walk.stream, (uint64_t(walk.vertex) << 32) + walk.sample + 1);
}

}  // namespace

struct BintreeDirect::Scratch final : DirectLightScratch {
  explicit Scratch(TreeSampler s) : sampler(std::move(s)) {}
  TreeSampler sampler;
};

BintreeDirect::BintreeDirect(const PreparedScene& scene, const RadiosityLight& radiosity,
                             const TreeSamplingOptions& options)
    : scene_(scene), radiosity_(radiosity), options_(options) {
  const RadiositySolution& solution = radiosity.solution();
  const auto lights = uint32_t(scene.scene.lights.size());
  const auto patches = uint32_t(solution.mesh.patches.size());
  index_of_source_.assign(size_t(lights) + patches, no_source);
  for (uint32_t e = 0; e < lights; ++e) {
    index_of_source_[e] = uint32_t(sources_.size());
    sources_.emplace_back(scene, e);
    everywhere_.push_back({e, {SourceView::occluded, SourceTreatment::probed, 0, 1, 0}});
  }
  for (uint32_t p = 0; p < patches; ++p)
    for (const TreatedSource& t : radiosity.selection().of_patch(p)) {
      if (index_of_source_[t.source] != no_source) continue;
      index_of_source_[t.source] = uint32_t(sources_.size());
      sources_.emplace_back(scene, solution, t.source - lights);
    }
}

std::unique_ptr<DirectLightScratch> BintreeDirect::make_scratch() const {
  return std::make_unique<Scratch>(TreeSampler(scene_, sources_, index_of_source_, options_));
}

void BintreeDirect::begin(const SampleRequest&, DirectLightScratch& scratch) const {
  static_cast<Scratch&>(scratch).sampler.forget_patterns();
}

std::span<const TreatedSource> BintreeDirect::treated_at(const RadiosityPlace& place) const {
  if (place.point == no_point) return everywhere_;
  return radiosity_.selection().of_patch(radiosity_.patch_of(place));
}

uint32_t BintreeDirect::note_of(const SurfaceScattering& s, const RadiosityPlace& place) const {
  if (!s.has_rough) return no_place;
  return place.point == no_point ? off_mesh : radiosity_.patch_of(place);
}

bool BintreeDirect::is_treated(uint32_t note, uint32_t light) const {
  if (note == no_place) return false;
  if (note == off_mesh) return true;
  for (const TreatedSource& t : radiosity_.selection().of_patch(note))
    if (t.source == light) return true;
  return false;
}

void BintreeDirect::queue(WaveHits& wave, DirectLightScratch& scratch, RadianceBatch& out,
                          Counters& counters) const {
  auto& s = static_cast<Scratch&>(scratch);
  radiosity_.places(wave);
  CheckItems items;
  for (size_t i = 0; i < wave.size(); ++i) {
    items.at(wave.walks[i].index);
    shade(wave, i, s, out, counters);
    wave.walks[i].last_place = note_of(wave.scatterings[i], wave.places[i]);
  }
}

void BintreeDirect::shade(WaveHits& wave, size_t i, Scratch& scratch, RadianceBatch& out,
                          Counters& counters) const {
  const Walk& walk = wave.walks[i];
  const Vertex& v = wave.vertices[i];
  const SurfaceScattering& s = wave.scatterings[i];
  if (!s.has_diffuse && !s.has_rough) return;
  const RadiosityPlace& place = wave.places[i];
  Rgb direct;
  if (place.point != no_point && s.has_diffuse)
    direct += albedo(s.diffuse, v.wo.z) * inv_pi_f * radiosity_.general(place).direct;
  const bool is_first = walk.vertex == 0;
  TreeReceiver receiver;
  receiver.vertex = &v;
  receiver.scattering = &s;
  receiver.stream = tree_stream(walk);
  receiver.depth = walk.vertex;
  receiver.throughput = is_first ? 1 : luminance(walk.throughput);
  if (is_first && wave.viewing != nullptr && !wave.viewing->neighbours.empty())
    receiver.neighbours = &wave.viewing->neighbours[walk.index];
  if (is_first && !out.records.empty()) receiver.record = &out.records[walk.index];
  const TreeLight light = scratch.sampler.run(receiver, treated_at(place));
  direct += light.from_lights;
  out.shadow_rays[walk.index] += light.rays;
  counters.shadow_rays += light.rays;
  counters.mixed += light.sampled;
  if (is_first)
    out.sources[walk.index] = {float(light.sampled), float(light.probed_visible),
                               float(light.probed_hidden)};
  out.add(walk.index, is_direct_at(walk), walk.throughput * direct, 0);
  out.add(walk.index, false, walk.throughput * light.from_patches, 0);
}

void BintreeDirect::weigh(SeenEmission& seen) const {
  for (size_t i = 0; i < seen.size(); ++i) {
    const Walk& walk = *seen.walks[i];
    const auto rays = float(options_.tree.initial_rays);
    if (seen.vertices[i] == nullptr) {
      const uint32_t primitive = seen.at_infinity[i];
      if (is_treated(walk.last_place, scene_.primitives[primitive].light))
        seen.weights[i] = miss_weight(scene_, walk, primitive, rays);
      continue;
    }
    const Vertex& v = *seen.vertices[i];
    const auto light = uint32_t(v.surface.light);
    if (!is_treated(walk.last_place, light)) continue;
    const float pdf_light = sources_[index_of_source_[light]].pdf_of_hit(scene_, walk.last_position,
                                                                         walk.ray.direction, v);
    seen.weights[i] = power_heuristic(walk.pdf, rays * pdf_light);
  }
}

}  // namespace troffer
