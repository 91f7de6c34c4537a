#include "integrate/certified_lights.h"

#include <algorithm>

#include "base/random.h"
#include "light/light.h"
#include "trace/occluders.h"

namespace troffer {

namespace {

// Lights of more pieces, once those in one plane are merged, are left to rays: each piece would
// be a source of its own.
constexpr uint32_t most_pieces = 256;
// Hits on a curved surface are certified together within this share of the scene's diagonal.
constexpr float reach_of_diagonal = 0.1f;

}  // namespace

CertifiedLights::CertifiedLights(const PreparedScene& scene, double error)
    : source_of_front_(scene.primitives.size(), -1),
      source_of_back_(scene.primitives.size(), -1),
      error_(float(error)) {
  for (uint32_t e = 0; e < scene.scene.lights.size(); ++e)
    has_light_.push_back(add_light(scene, e));
  const Box box = bounds(scene.scene);
  if (!box.is_empty()) reach_ = reach_of_diagonal * box.diagonal();
}

namespace {

// Whether a point in the source's plane belongs to it.
bool covers(const FlatSource& s, const Vec3& point) {
  if (s.is_disk) return true;
  const Vec3d d = Vec3d(point) - s.plane.origin, n = cross(s.plane.u, s.plane.v);
  const double area2 = length_squared(n);
  const double u = dot(cross(d, s.plane.v), n) / area2, v = dot(cross(s.plane.u, d), n) / area2;
  if (s.outline.empty()) return u >= 0 && u <= 1 && v >= 0 && v <= 1;
  int left = 0, right = 0;
  for (size_t i = 0; i < s.outline.size(); ++i) {
    const Vec2d p(s.outline[i]), q(s.outline[(i + 1) % s.outline.size()]);
    const double side = (q.x - p.x) * (v - p.y) - (q.y - p.y) * (u - p.x);
    left += side > 0;
    right += side < 0;
  }
  return left == 0 || right == 0;
}

}  // namespace

const CertifiedSource* CertifiedLights::source_of(uint32_t primitive, bool is_back,
                                                  const Vec3& point) const {
  int32_t i = (is_back ? source_of_back_ : source_of_front_)[primitive];
  if (i < 0) return nullptr;
  // of a polygon in several parts
  while (before_[size_t(i)] >= 0 && !covers(sources_[size_t(i)].flat, point))
    i = before_[size_t(i)];
  return &sources_[size_t(i)];
}

void CertifiedLights::add_source(const CertifiedSource& source,
                                 std::span<const uint32_t> primitives) {
  std::vector<int32_t>& last = source.is_back ? source_of_back_ : source_of_front_;
  before_.push_back(last[primitives[0]]);
  for (const uint32_t p : primitives) last[p] = int32_t(sources_.size());
  sources_.push_back(source);
}

bool CertifiedLights::add_light(const PreparedScene& scene, uint32_t light) {
  if (certificate_shape(scene.scene, scene.scene.lights[light]) == CertificateShape::none)
    return false;
  const LightPrimitives::Range pieces = scene.primitives.of_light(light);
  std::vector<SourcePiece> merged;
  if (merge_sources(scene.primitives, light, merged)) return add_flat_light(scene, light, merged);
  if (pieces.last - pieces.first > most_pieces) return false;
  std::vector<CertifiedSource> added;
  for (uint32_t p = pieces.first; p < pieces.last; ++p) {
    const LightPrimitive& piece = scene.primitives[p];
    CertifiedSource source;
    source.primitive = p;
    source.is_textured = piece.is_textured;
    source.radiance = piece.is_textured ? piece.mean_radiance : scene.scene.lights[light].radiance;
    if (piece.shape == PrimitiveShape::sphere) {
      source.is_round = true;
      const auto meshes = uint32_t(scene.scene.meshes.size());
      source.sphere = {Vec3d(piece.centroid), double(piece.radius),
                       Occluders::key(meshes, scene.scene.lights[light].geometry)};
      source.stream = hash_of(p, 0u);
      added.push_back(source);
      continue;
    }
    for (const bool is_back : {false, true}) {
      if (is_back && !piece.is_two_sided) continue;
      if (!make_flat_source(piece, is_back, source.flat)) return false;
      source.is_back = is_back;
      source.stream = hash_of(p, is_back ? 1u : 0u);
      added.push_back(source);
    }
  }
  for (const CertifiedSource& source : added) add_source(source, {&source.primitive, 1});
  return true;
}

// Of one radiance.
bool CertifiedLights::add_flat_light(const PreparedScene& scene, uint32_t light,
                                     const std::vector<SourcePiece>& pieces) {
  if (pieces.size() > most_pieces) return false;
  for (const SourcePiece& piece : pieces) {
    CertifiedSource source;
    source.flat = piece.shape;
    source.primitive = piece.primitives[0];
    source.radiance = scene.scene.lights[light].radiance;
    for (const bool is_back : {false, true}) {
      if (is_back && !scene.scene.lights[light].is_two_sided) continue;
      if (is_back) source.flat.plane.normal = -source.flat.plane.normal;
      source.is_back = is_back;
      source.stream = hash_of(sources_.size(), 2u);  // parts of a polygon share a primitive
      add_source(source, piece.primitives);
    }
  }
  return true;
}

void CertifiedLights::illuminate(CertifiedLightsScratch& s, RadianceBatch& out,
                                 Counters& counters) const {
  if (s.hits.size() == 0) return;
  cluster_receivers(s.hits.positions, s.hits.horizons, reach_, s.clusters);
  for (size_t c = 0; c < s.clusters.size(); ++c)
    illuminate_cluster(s.clusters.members(c), s, out, counters);
  s.hits.clear();
}

void CertifiedLights::illuminate_cluster(std::span<const uint32_t> members,
                                         CertifiedLightsScratch& s, RadianceBatch& out,
                                         Counters& counters) const {
  s.cluster.receivers.clear();
  s.integrand.hits().clear();
  for (const uint32_t m : members) {
    s.cluster.receivers.push_back(s.hits.receivers[m]);
    const int32_t g = s.hits.glossy[m];
    s.integrand.hits().push_back(
        {s.hits.positions[m], g < 0 ? nullptr : &s.hits.glossy_hits[size_t(g)]});
  }
  s.cluster.shadow.set(s.cluster.receivers);
  choose(members, s);
  set_requests(s);
  s.drawn_sums.assign(members.size(), 0);
  s.drawn_squares.assign(members.size(), 0);
  for (const uint32_t weak : s.weak.weak) add_unoccluded(sources_[weak], members, s, out);
  certified_light(s.cluster.shadow, s.cluster.requests, &s.integrand, s.world, s.options,
                  s.cluster.memory,
                  [&](uint32_t request, std::span<const SourceVisibility> answers) {
                    add_answers(request, members, answers, s, out, counters);
                  });
  add_drawing_variance(members, s, out);
}

void CertifiedLights::set_requests(CertifiedLightsScratch& s) const {
  s.cluster.requests.clear();
  s.integrand.sources().clear();
  for (const ChosenSource& chosen : s.weak.chosen) {
    const CertifiedSource& source = sources_[chosen.source];
    LightRequest& r = s.cluster.requests.emplace_back();
    if (source.is_round)
      r.sphere = &source.sphere;
    else
      r.flat = &source.flat;
    r.stream = source.stream;
    r.brightness = luminance(source.radiance) * chosen.weight;
    r.found = &s.found[chosen.source];
    s.integrand.sources().push_back(&source);
  }
}

// The sources to treat: all of them where a surface may pick the light of a weak one out.
void CertifiedLights::choose(std::span<const uint32_t> members, CertifiedLightsScratch& s) const {
  Box box;
  ClusterBall ball;
  ball.normal = s.cluster.receivers[0].normal;
  bool is_matte = true;
  for (size_t i = 0; i < members.size(); ++i) {
    const ShadowReceiver& r = s.cluster.receivers[i];
    box.grow(r.position);
    is_matte = is_matte && s.hits.glossy[members[i]] < 0;
    if (length_squared(r.normal - s.cluster.receivers[0].normal) > 1e-10f ||
        length_squared(r.horizon - s.cluster.receivers[0].normal) > 1e-10f)
      ball.normal = {};
  }
  ball.centre = (box.lower + box.upper) * 0.5f;
  ball.radius = 0.5f * box.diagonal();
  // those of a normal in common need not lie in one plane
  for (const ShadowReceiver& r : s.cluster.receivers)
    ball.depth = std::max(ball.depth, dot(ball.normal, ball.centre - r.position));
  choose_sources(sources_, ball, is_matte ? 0.5f * error_ : 0.0f,
                 hash_combine(s.cluster.receivers[0].stream, members.size()), s.weak);
}

void CertifiedLights::add_unoccluded(const CertifiedSource& source,
                                     std::span<const uint32_t> members, CertifiedLightsScratch& s,
                                     RadianceBatch& out) const {
  if (source.is_round)
    unoccluded_light(s.cluster.shadow, source.sphere, s.unoccluded);
  else
    unoccluded_light(s.cluster.shadow, source.flat, s.unoccluded);
  for (uint32_t i = 0; i < members.size(); ++i) {
    if (!(s.unoccluded[i] > 0)) continue;
    const uint32_t m = members[i];
    out.add(s.hits.indices[m], s.hits.is_direct[m] != 0,
            s.hits.weights[m] * source.radiance * s.unoccluded[i], 0);
  }
}

void CertifiedLights::add_answers(uint32_t request, std::span<const uint32_t> members,
                                  std::span<const SourceVisibility> answers,
                                  CertifiedLightsScratch& s, RadianceBatch& out,
                                  Counters& counters) const {
  const ChosenSource& chosen = s.weak.chosen[request];
  const CertifiedSource& source = sources_[chosen.source];
  for (uint32_t i = 0; i < members.size(); ++i) {
    const SourceVisibility& a = answers[i];
    if (a.answer == ShadowAnswer::below) continue;
    count_answer(a, counters);
    const uint32_t m = members[i], index = s.hits.indices[m];
    if (a.rays > 0) out.shadow_rays[index] += a.rays;
    const bool is_lit = a.answer == ShadowAnswer::lit, is_dark = a.answer == ShadowAnswer::dark;
    if (s.hits.is_first[m] != 0)
      out.sources[index] +=
          Rgb{is_lit || is_dark ? 0.0f : 1.0f, is_lit ? 1.0f : 0.0f, is_dark ? 1.0f : 0.0f};
    if (is_dark && !chosen.is_drawn()) continue;
    const bool is_direct = s.hits.is_direct[m] != 0;
    if (chosen.is_drawn()) {  // of matte receivers
      const Rgb missing =
          s.hits.weights[m] * source.radiance * (chosen.weight * a.unoccluded * (1 - a.visible));
      out.add(index, is_direct, missing * -1.0f, 0);
      s.drawn_sums[i] += is_direct ? luminance(missing) : 0.0f;
      s.drawn_squares[i] += is_direct ? sqr(luminance(missing)) / float(chosen.draws) : 0.0f;
      continue;
    }
    const bool has_value = s.integrand.is_wanted(request, i);
    const Rgb factor = has_value ? s.hits.weights[m] : s.hits.weights[m] * source.radiance;
    out.add(index, is_direct, has_value ? factor * a.value : factor * (a.unoccluded * a.visible),
            has_value ? sqr(luminance(factor)) * a.value_variance
                      : sqr(luminance(factor) * a.unoccluded) * a.variance);
  }
}

// What drawing some of the weak sources adds, from the spread of what is missing of them. Hits of
// one pixel, which stand side by side, share the draw, so that their errors add up.
void CertifiedLights::add_drawing_variance(std::span<const uint32_t> members,
                                           const CertifiedLightsScratch& s,
                                           RadianceBatch& out) const {
  float drawn = 0;
  for (const ChosenSource& c : s.weak.chosen) drawn += float(c.draws);
  if (drawn < 2 || out.direct_variance.empty()) return;
  const auto pixel = [&](size_t i) { return s.hits.pixels[members[i]]; };
  for (size_t first = 0, end = 0; first < members.size(); first = end) {
    while (end < members.size() && pixel(end) == pixel(first)) ++end;
    for (size_t i = first; i < end; ++i) {
      const float spread = std::max(s.drawn_squares[i] - sqr(s.drawn_sums[i]) / drawn, 0.0f);
      out.direct_variance[s.hits.indices[members[i]]] +=
          spread * drawn / (drawn - 1) * float(end - first);
    }
  }
}

}  // namespace troffer
