#include "integrate/flat_lights.h"

#include "base/random.h"

namespace troffer {

namespace {

// Emitters of more pieces are left to rays: each piece would be a source of its own.
constexpr uint32_t most_pieces = 64;
// Hits on a curved surface are certified together within this share of the scene's diagonal.
constexpr float reach_of_diagonal = 0.1f;

}  // namespace

void MatteHits::clear() {
  receivers.clear();
  positions.clear();
  horizons.clear();
  weights.clear();
  indices.clear();
  is_direct.clear();
  is_first.clear();
}

void MatteHits::add(const Walk& walk, const Vertex& v, Rgb reflectance, bool direct) {
  const Vec3& horizon = v.geometric_normal;
  receivers.push_back({v.surface.position, horizon, v.frame.normal,
                       offset_origin(v.surface, horizon),
                       hash_combine(walk.stream, (uint64_t(walk.vertex) << 32) + walk.sample + 1)});
  positions.push_back(v.surface.position);
  horizons.push_back(horizon);
  weights.push_back(walk.throughput * reflectance * inv_pi_f);
  indices.push_back(walk.index);
  is_direct.push_back(direct ? 1 : 0);
  is_first.push_back(walk.vertex == 0 ? 1 : 0);
}

FlatLights::FlatLights(const PreparedScene& scene) {
  for (uint32_t e = 0; e < scene.scene.emitters.size(); ++e)
    has_emitter_.push_back(add_emitter(scene, e));
  const Box box = bounds(scene.scene);
  if (!box.is_empty()) reach_ = reach_of_diagonal * box.diagonal();
}

bool FlatLights::add_emitter(const PreparedScene& scene, uint32_t emitter) {
  const LightPrimitives::Range pieces = scene.lights.of_emitter(emitter);
  if (pieces.last - pieces.first > most_pieces) return false;
  std::vector<Source> added;
  for (uint32_t p = pieces.first; p < pieces.last; ++p) {
    const LightPrimitive& piece = scene.lights[p];
    if (piece.is_textured) return false;
    for (const bool is_back : {false, true}) {
      if (is_back && !piece.is_two_sided) continue;
      Source source;
      if (!make_flat_source(piece, is_back, source.shape)) return false;
      source.radiance = scene.scene.emitters[emitter].radiance;
      source.stream = hash_of(p, is_back ? 1u : 0u);
      added.push_back(std::move(source));
    }
  }
  sources_.insert(sources_.end(), added.begin(), added.end());
  return true;
}

void FlatLights::illuminate(FlatLightsScratch& s, RadianceBatch& out, Counters& counters) const {
  if (s.hits.size() == 0) return;
  cluster_receivers(s.hits.positions, s.hits.horizons, reach_, s.clusters);
  for (size_t c = 0; c < s.clusters.size(); ++c) {
    const auto members = s.clusters.members(c);
    s.receivers.clear();
    for (const uint32_t m : members) s.receivers.push_back(s.hits.receivers[m]);
    s.answers.resize(members.size());
    s.estimator.begin_cluster(s.receivers);
    for (size_t i = 0; i < sources_.size(); ++i) {
      s.estimator.evaluate(sources_[i].shape, sources_[i].stream, s.world, s.found[i], s.answers);
      add_answers(sources_[i], members, s, out, counters);
    }
  }
  s.hits.clear();
}

void FlatLights::add_answers(const Source& source, std::span<const uint32_t> members,
                             const FlatLightsScratch& s, RadianceBatch& out,
                             Counters& counters) const {
  for (size_t i = 0; i < members.size(); ++i) {
    const SourceVisibility& a = s.answers[i];
    if (a.answer == ShadowAnswer::below) continue;
    const uint32_t m = members[i], index = s.hits.indices[m];
    const bool is_lit = a.answer == ShadowAnswer::lit, is_dark = a.answer == ShadowAnswer::dark;
    counters.lit_certified += is_lit ? 1 : 0;
    counters.dark_certified += is_dark ? 1 : 0;
    counters.masked += a.answer == ShadowAnswer::masked ? 1 : 0;
    counters.mixed += a.answer == ShadowAnswer::mixed ? 1 : 0;
    counters.shadow_rays += a.rays;
    out.shadow_rays[index] += a.rays;
    if (s.hits.is_first[m] != 0)
      out.sources[index] +=
          Rgb{is_lit || is_dark ? 0.0f : 1.0f, is_lit ? 1.0f : 0.0f, is_dark ? 1.0f : 0.0f};
    if (is_dark) continue;
    (s.hits.is_direct[m] != 0 ? out.direct : out.indirect)[index] +=
        s.hits.weights[m] * source.radiance * (a.unoccluded * a.visible);
  }
}

}  // namespace troffer
