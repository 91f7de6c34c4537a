#include "certified/certified_sources.h"

#include <algorithm>

#include "base/ablation.h"
#include "base/random.h"
#include "certified/lit_surfaces.h"
#include "certified/open_parts.h"
#include "light/light.h"
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
// them in their true directions to 2^-18 (docs/method/certified-appendix.md, "Lights at infinity").
// Farther receivers, such as measuring points, use rays.
constexpr float reach_of_far_cells = 256;

}  // namespace

CertifiedSources::CertifiedSources(const PreparedScene& scene, bool are_drawn,
                                   uint32_t gloss_points)
    : scene_(scene),
      competition_(scene, gloss_points),
      source_of_front_(scene.primitives.size(), -1),
      source_of_back_(scene.primitives.size(), -1),
      environment_{&scene.far_cells(), 0, nullptr, {}, {}, {}, false, {}, 0, {}, 0} {
  for (uint32_t e = 0; e < scene.scene.lights.size(); ++e)
    has_light_.push_back(add_light(scene, e));
  add_far_lights(scene);
  add_drawn_lights(scene);
  groups_.finish();
  competition_ =
      NominalSourceDensity(scene, gloss_points, groups_, groups_.are_many() || are_drawn);
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

const CertifiedSource* CertifiedSources::source_of(uint32_t primitive, bool is_back,
                                                   const Vec3& point) const {
  int32_t i = (is_back ? source_of_back_ : source_of_front_)[primitive];
  if (i < 0) return nullptr;
  // A polygon light may have several parts that share a primitive. They cover it, so a point that
  // rounding places beside all of them lies at the edge of one; it counts as the last in the list.
  while (before_[size_t(i)] >= 0 && !covers(sources_[size_t(i)].flat, point))
    i = before_[size_t(i)];
  return &sources_[size_t(i)];
}

void CertifiedSources::add_source(const CertifiedSource& source,
                                  std::span<const uint32_t> primitives) {
  std::vector<int32_t>& last = source.is_back ? source_of_back_ : source_of_front_;
  before_.push_back(last[primitives[0]]);
  for (const uint32_t p : primitives) last[p] = int32_t(sources_.size());
  sources_.push_back(source);
}

bool CertifiedSources::add_light(const PreparedScene& scene, uint32_t light) {
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
bool CertifiedSources::add_flat_light(const PreparedScene& scene, uint32_t light,
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

void CertifiedSources::set_occluders(const Occluders& occluders) {
  if (environment_.cells->all().empty()) return;
  environment_.occluders = &occluders;
  environment_.scene = large_facets(occluders);
  if (!is_left_out<"closed shells">())
    environment_.shells =
        ClosedShells(scene_.scene, scene_.panes.is_empty() ? nullptr : &scene_.glass);
  environment_.seems_shut_out =
      !is_left_out<"seems shut out">() &&
      are_lit_surfaces_closed(scene_, environment_.points, environment_.shells);
}

void CertifiedSources::add_far_lights(const PreparedScene& scene) {
  environment_.first_source = uint32_t(sources_.size());
  const Box everywhere = bounds(scene.scene);
  environment_.frame_reach = reach_of_frame * double(everywhere.diagonal());
  environment_.centre = everywhere.is_empty() ? Vec3{} : everywhere.centre();
  environment_.reach = reach_of_far_cells * 0.5f * everywhere.diagonal();
  environment_.frames.resize(scene.primitives.size());
  for (const uint32_t p : scene.primitives.at_infinity())
    if (const Portal* portal = scene.primitives[p].portal)
      for (const Quad& q : portal->frame(environment_.frame_reach))
        environment_.frames[p].push_back({q, no_facet, false});
  for (const SkyPatch& cell : environment_.cells->all()) {
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
  environment_.points = EnvironmentSampler(std::span(sources_).subspan(environment_.first_source));
}

const CertifiedSource* CertifiedSources::source_towards(uint32_t primitive,
                                                        const Vec3& direction) const {
  for (size_t i = environment_.first_source; i < sources_.size(); ++i)
    if (sources_[i].primitive == primitive && sources_[i].far->holds(direction))
      return &sources_[i];
  return nullptr;
}

// Groups the primitives of lights that have a surface but no certificates. Above most_groups
// triangles, neighbouring ones share a group.
void CertifiedSources::add_drawn_lights(const PreparedScene& scene) {
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

}  // namespace troffer
