#include "certified/certified_lights.h"

#include <algorithm>

#include "base/random.h"
#include "certified/lit_surfaces.h"
#include "certified/open_parts.h"
#include "light/light.h"
#include "shadow/pilot_rays.h"
#include "trace/occluders.h"

namespace troffer {

namespace {

// Largest number of flat pieces of a mesh light, after coplanar ones are merged. Each piece is one
// source, so larger meshes are sampled instead.
constexpr uint32_t most_pieces = 256;
// Largest extent of a cluster on a curved surface, relative to the scene's diagonal.
constexpr float reach_of_diagonal = 0.1f;
// Extent of a portal's frame beyond its sides, in scene diagonals.
constexpr double reach_of_frame = 16;
// Sky patches lie at a finite distance. Receivers within this many scene radii of the centre see
// them in their true directions to 2^-18 (docs/method/certified.md, "Lights at infinity"). Farther
// receivers, such as measuring points, use rays.
constexpr float reach_of_far_cells = 256;

}  // namespace

CertifiedLights::CertifiedLights(const PreparedScene& scene, const DrawingBudget& budget,
                                 uint32_t gloss_points)
    : scene_(scene),
      competition_(scene, gloss_points),
      source_of_front_(scene.primitives.size(), -1),
      source_of_back_(scene.primitives.size(), -1),
      far_{&scene.far_cells(), 0, nullptr, {}, {}, {}, false, {}, 0, {}, 0},
      budget_(budget) {
  for (uint32_t e = 0; e < scene.scene.lights.size(); ++e)
    has_light_.push_back(add_light(scene, e));
  add_far_lights(scene);
  add_drawn_lights(scene);
  groups_.finish();
  competition_ =
      NominalSourceDensity(scene, gloss_points, groups_, groups_.are_many() || budget.draws > 0);
  const Box box = bounds(scene.scene);
  if (!box.is_empty()) reach_ = reach_of_diagonal * box.diagonal();
}

namespace {

// True if a point in the source's plane lies within the source. Disks always return true.
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
  // A polygon light may have several parts that share a primitive.
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
  std::vector<uint32_t> ends;  // per piece: end of its sources in `added`
  for (uint32_t p = pieces.first; p < pieces.last; ++p) {
    const LightPrimitive& piece = scene.primitives[p];
    CertifiedSource source;
    source.primitive = p;
    source.is_textured = piece.is_textured;
    source.is_by_web = scene.scene.lights[light].web != no_web;
    source.radiance = piece.is_textured ? piece.mean_radiance : scene.scene.lights[light].radiance;
    if (piece.shape == PrimitiveShape::sphere) {
      source.is_round = true;
      const auto meshes = uint32_t(scene.scene.meshes.size());
      source.sphere = {Vec3d(piece.centroid), double(piece.radius),
                       Occluders::key(meshes, scene.scene.lights[light].geometry)};
      source.stream = hash_of(p, 0u);
      added.push_back(source);
      ends.push_back(uint32_t(added.size()));
      continue;
    }
    for (const bool is_back : {false, true}) {
      if (is_back && !piece.is_two_sided) continue;
      if (!make_flat_source(piece, is_back, source.flat)) return false;
      source.is_back = is_back;
      source.stream = hash_of(p, is_back ? 1u : 0u);
      added.push_back(source);
    }
    ends.push_back(uint32_t(added.size()));
  }
  const auto first = uint32_t(sources_.size());
  for (const CertifiedSource& source : added) add_source(source, {&source.primitive, 1});
  for (uint32_t p = pieces.first, begin = 0; p < pieces.last; begin = ends[p - pieces.first], ++p)
    groups_.add(scene.primitives, {&p, 1}, first + begin, first + ends[p - pieces.first]);
  return true;
}

// Adds the flat pieces of a light of uniform radiance.
bool CertifiedLights::add_flat_light(const PreparedScene& scene, uint32_t light,
                                     const std::vector<SourcePiece>& pieces) {
  if (pieces.size() > most_pieces) return false;
  auto first = uint32_t(sources_.size());
  for (size_t i = 0; i < pieces.size(); ++i) {
    const SourcePiece& piece = pieces[i];
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
    // All parts of one polygon form one group.
    if (i + 1 < pieces.size() && pieces[i + 1].primitives == piece.primitives) continue;
    groups_.add(scene.primitives, piece.primitives, first, uint32_t(sources_.size()));
    first = uint32_t(sources_.size());
  }
  return true;
}

void CertifiedLights::set_occluders(const Occluders& occluders) {
  if (far_.cells->all().empty()) return;
  far_.occluders = &occluders;
  far_.scene = large_facets(occluders);
  far_.shells = ClosedShells(scene_.scene, scene_.panes.is_empty() ? nullptr : &scene_.glass);
  far_.seems_shut_out = are_lit_surfaces_closed(scene_, far_.points, far_.shells);
}

void CertifiedLights::add_far_lights(const PreparedScene& scene) {
  far_.first_source = uint32_t(sources_.size());
  const Box everywhere = bounds(scene.scene);
  far_.frame_reach = reach_of_frame * double(everywhere.diagonal());
  far_.centre = everywhere.is_empty() ? Vec3{} : everywhere.centre();
  far_.reach = reach_of_far_cells * 0.5f * everywhere.diagonal();
  far_.frames.resize(scene.primitives.size());
  for (const uint32_t p : scene.primitives.at_infinity())
    if (const Portal* portal = scene.primitives[p].portal)
      for (const Quad& q : portal->frame(far_.frame_reach))
        far_.frames[p].push_back({q, no_facet, false});
  for (const SkyPatch& cell : far_.cells->all()) {
    has_light_[scene.primitives[cell.primitive].light] = true;
    const Portal* portal = scene.primitives[cell.primitive].portal;
    if (portal != nullptr && portal->view(everywhere, cell.plane) == Portal::View::none) continue;
    CertifiedSource source;
    source.flat.plane = cell.plane;
    source.flat.is_disk = cell.is_disk;
    source.radiance = cell.mean;
    source.is_textured = !cell.is_even;
    source.primitive = cell.primitive;
    source.stream = hash_of(sources_.size(), 3u);
    source.far = &cell;
    const Vec3d middle = cell.plane.origin + (cell.plane.u + cell.plane.v) * 0.5;
    const Vec3d from(everywhere.centre());
    source.towards = normalize(Vec3(middle - from));
    source.solid_angle = float(source.unoccluded(from, Vec3d(source.towards)));
    sources_.push_back(source);
    before_.push_back(-1);
  }
  far_.points = EnvironmentSampler(std::span(sources_).subspan(far_.first_source));
}

const CertifiedSource* CertifiedLights::source_towards(uint32_t primitive,
                                                       const Vec3& direction) const {
  for (size_t i = far_.first_source; i < sources_.size(); ++i)
    if (sources_[i].primitive == primitive && sources_[i].far->holds(direction))
      return &sources_[i];
  return nullptr;
}

// Groups the primitives of lights that have a surface but no certificates. Above most_groups
// triangles, neighbouring ones share a group.
void CertifiedLights::add_drawn_lights(const PreparedScene& scene) {
  constexpr uint32_t most_groups = 8192;
  const auto lights = uint32_t(scene.scene.lights.size());
  is_drawn_.assign(lights, false);
  uint32_t pieces = 0;
  for (uint32_t e = 0; e < lights; ++e) {
    const LightPrimitives::Range range = scene.primitives.of_light(e);
    if (has_light_[e] || range.first == range.last) continue;
    is_drawn_[e] = scene.primitives[range.first].has_surface();
    if (is_drawn_[e]) pieces += range.last - range.first;
  }
  const uint32_t together = (pieces + most_groups - 1) / most_groups;
  std::vector<uint32_t> some;
  for (uint32_t e = 0; e < lights; ++e) {
    if (!is_drawn_[e]) continue;
    const LightPrimitives::Range range = scene.primitives.of_light(e);
    for (uint32_t p = range.first; p < range.last; p += together) {
      some.clear();
      for (uint32_t i = p; i < std::min(p + together, range.last); ++i) some.push_back(i);
      groups_.add(scene.primitives, some, 0, 0);
    }
  }
}

void CertifiedLights::illuminate(CertifiedLightsScratch& s, RadianceBatch& out,
                                 Counters& counters) const {
  if (s.hits.size() == 0) return;
  if (!find_closed_off(s)) s.far = estimate_environment_share(far_draws(s), far_.seems_shut_out);
  cluster_receivers(s.hits.positions, s.hits.horizons, reach_, s.clusters);
  for (size_t c = 0; c < s.clusters.size(); ++c)
    illuminate_cluster(s.clusters.members(c), s, out, counters);
  resolve_draws(scene_, s.hits, s.drawn, out, counters);
  s.hits.clear();
}

bool CertifiedLights::find_closed_off(CertifiedLightsScratch& s) const {
  s.is_closed_off.assign(s.hits.size(), far_.points.is_empty() ? 1 : 0);
  if (far_.points.is_empty()) return true;
  if (far_.shells.is_empty()) return false;
  bool are_all = true;
  for (size_t i = 0; i < s.hits.size(); ++i) {
    s.is_closed_off[i] = far_.shells.hold(s.hits.receivers[i].origin) ? 1 : 0;
    are_all = are_all && s.is_closed_off[i] != 0;
  }
  return are_all;
}

// Counts all sky patches as proved dark for these hits.
void CertifiedLights::count_closed_off(std::span<const uint32_t> members,
                                       const CertifiedLightsScratch& s, RadianceBatch& out,
                                       Counters& counters) const {
  const size_t far = far_.cells->all().size();
  counters.dark_certified += members.size() * far;
  for (const uint32_t m : members)
    if (s.hits.is_first[m] != 0) out.sources[s.hits.indices[m]] += Rgb{0, 0, float(far)};
}

bool CertifiedLights::may_be_proved_far(std::span<const uint32_t> members,
                                        const CertifiedLightsScratch& s) const {
  return std::all_of(members.begin(), members.end(), [&](uint32_t m) {
    return length(s.hits.positions[m] - far_.centre) <= far_.reach;
  });
}

namespace {

// Rays per hit so that the sky's light and the suns' light each err by `error`, relative to what
// arrives.
double rays_of_hit(const EnvironmentShare& share, bool has_suns, double error) {
  const double of_suns = std::sqrt(share.spread_of_sun) / (share.open * error);
  return rays_for_error(share.open_sky, error) + (has_suns ? std::pow(of_suns, 4.0 / 3) : 0.0);
}

}  // namespace

// True if proofs for sky patches are expected to cost less than rays to them. Always true for
// measuring points unless the scene seems closed: their proofs may take longer.
bool CertifiedLights::is_proof_of_far_worth(std::span<const uint32_t> members,
                                            const CertifiedLightsScratch& s,
                                            const RadianceBatch& out) const {
  constexpr double cost_of_look = 4000;  // in rays: shaft and facet lists of all patches
  constexpr double cost_of_gloss = 4;    // in rays per sky patch, extra for a glossy hit
  // rays of a pixel's further viewing rays, relative to the first ones
  constexpr double share_of_further = 0.25;
  // Above the open share `open_enough`, proofs need more than cost_of_mask rays per sky patch to
  // pay.
  constexpr double cost_of_mask = 40, open_enough = 0.25;
  if (s.far.seems_closed) return false;
  if (!s.request.is_picture) return true;
  if (s.far.is_behind_clutter) return false;
  const double rays = rays_of_hit(s.far, far_.points.suns() > 0, double(s.options.mask_error));
  const size_t cells = sources_.size() - far_.first_source;
  if (s.far.open > open_enough && rays < cost_of_mask * double(cells)) return false;
  double all = 0, proofs = cost_of_look;
  for (const uint32_t m : members) {
    all += s.hits.samples[m] < uint32_t(budget_.viewing_rays)
               ? rays
               : rays * share_of_further / s.request.effort_divisor;
    if (s.hits.glossy[m] >= 0) proofs += cost_of_gloss * double(cells);
  }
  return all > proofs;
}

void CertifiedLights::set_requests(CertifiedLightsScratch& s, bool has_far) const {
  s.cluster.requests.clear();
  s.requested.clear();
  s.integrand.sources().clear();
  s.integrand.behind_panes().clear();
  s.integrand.portals().clear();
  Box receivers;
  for (const ShadowReceiver& r : s.cluster.receivers) receivers.grow(r.position);
  const auto add = [&](uint32_t i) {
    const CertifiedSource& source = sources_[i];
    const Portal* portal = scene_.primitives[source.primitive].portal;
    const Portal::View view =
        portal == nullptr ? Portal::View::all : portal->view(receivers, source.flat.plane);
    if (view == Portal::View::none) return;
    const bool is_cut = view == Portal::View::some;
    const bool is_left =
        is_cut && !portal->is_framed(far_.frame_reach, receivers, source.flat.plane);
    s.integrand.portals().push_back(is_left ? portal : nullptr);
    LightRequest& r = s.cluster.requests.emplace_back();
    if (is_cut) r.frame = far_.frames[source.primitive];
    r.sphere = source.is_round ? &source.sphere : nullptr;
    r.flat = source.is_round ? nullptr : &source.flat;
    r.stream = source.stream;
    r.brightness = luminance(source.radiance);
    r.found = &s.found[i];
    r.batch = s.hits.receivers;
    if (source.far != nullptr) r.far = &far_.scene;
    s.requested.push_back(i);
    s.integrand.sources().push_back(&source);
    if (!scene_.panes.is_empty())
      scene_.panes.between(receivers, source.bounds(), s.integrand.behind_panes().emplace_back());
  };
  for (const uint32_t g : s.chosen.certified)
    for (uint32_t i = groups_[g].first_source; i < groups_[g].last_source; ++i) add(i);
  if (!has_far) return;
  for (auto i = far_.first_source; i < uint32_t(sources_.size()); ++i) add(i);
}

void CertifiedLights::add_answers(uint32_t request, std::span<const uint32_t> members,
                                  std::span<const SourceVisibility> answers,
                                  CertifiedLightsScratch& s, RadianceBatch& out,
                                  Counters& counters) const {
  const CertifiedSource& source = sources_[s.requested[request]];
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
    if (is_dark) continue;
    const bool has_value = s.integrand.is_wanted(request, i);
    Rgb factor = has_value ? s.hits.weights[m] : s.hits.weights[m] * source.radiance;
    const int32_t g = s.hits.glossy[m];
    if (g >= 0 && s.hits.glossy_hits[size_t(g)].is_low_variance)
      factor *= low_variance_value(s.hits.glossy_hits[size_t(g)], source, s.hits.positions[m]);
    out.add(index, s.hits.is_direct[m] != 0,
            has_value ? factor * a.value : factor * (a.unoccluded * a.visible),
            has_value ? sqr(luminance(factor)) * a.value_variance
                      : sqr(luminance(factor) * a.unoccluded) * a.variance);
  }
}

}  // namespace troffer
