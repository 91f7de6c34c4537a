#include "report/find_surfaces.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/random.h"
#include "base/warp.h"
#include "report/above.h"
#include "report/find_floors.h"
#include "report/flat_faces.h"
#include "report/plan_view.h"
#include "scene/names.h"
#include "trace/surface.h"

namespace troffer {

namespace {

constexpr size_t most_surfaces = 64;
constexpr double least_desk = 0.25, least_side = 0.35;  // m², m
constexpr double desk_room = 0.5;                       // m
// heights above the floor, m
constexpr double desk_low = 0.6, desk_high = 0.95, tallest_desk = 1.4;

std::vector<Vec3d> grid_places(const AssessedSurface& s) {
  std::vector<Vec3d> places;
  const SurfaceGrid grid = grid_of(s);
  const size_t step = 1 + grid.points.size() / 64;
  for (size_t i = 0; i < grid.points.size(); i += step) places.push_back(grid.points[i].position);
  return places;
}

// Returns the share of a surface's places that have at least `height` metres of free space above.
double clear_share(const PreparedScene& scene, const AssessedSurface& s, const Vec3d& up,
                   double height) {
  double clear = 0;
  const std::vector<Above> found = above(scene, grid_places(s), up);
  for (const Above& a : found) clear += a.height >= height && !a.is_within ? 1 : 0;
  return clear / double(found.size());
}

AssessedSurface surface_of(const FlatFace& face, const Vec3d& n, SurfaceKind kind,
                           const std::string& profile) {
  AssessedSurface s = surface_of_triangles(face.triangles, n);
  s.name = face.name;
  s.kind = kind;
  s.profile = profile;
  return s;
}

std::vector<AssessedSurface> find_desks(const PreparedScene& scene,
                                        const std::vector<FlatFace>& faces,
                                        const std::vector<AssessedSurface>& floors, const Vec3d& up,
                                        const std::string& profile) {
  std::vector<AssessedSurface> desks;
  for (const FlatFace& f : faces) {
    if (f.area < least_desk) continue;
    AssessedSurface s = surface_of(f, up, SurfaceKind::desk, profile);
    if (std::min(s.width, s.height) < least_side) continue;
    s.above_floor = height_over(floors, s, up, tallest_desk);
    if (s.above_floor < desk_low || s.above_floor > desk_high) continue;
    if (clear_share(scene, s, up, desk_room) < 0.5) continue;
    desks.push_back(std::move(s));
  }
  number_names(desks, up);
  std::stable_sort(desks.begin(), desks.end(),
                   [](const AssessedSurface& a, const AssessedSurface& b) {
                     return natural_less(a.name, b.name);
                   });
  return desks;
}

// Limits the number of surfaces. Desks are dropped first: floors come last in the list, and the
// glare of the room is judged from them.
void keep_most(FoundSurfaces& found) {
  if (found.surfaces.size() <= most_surfaces) return;
  const auto is_desk = [](const AssessedSurface& s) {
    return s.kind == SurfaceKind::desk || s.kind == SurfaceKind::given;
  };
  const auto last_desk = std::find_if_not(found.surfaces.begin(), found.surfaces.end(), is_desk);
  const size_t excess = found.surfaces.size() - most_surfaces;
  const auto desks = size_t(last_desk - found.surfaces.begin());
  const size_t dropped = std::min(excess, desks - std::min<size_t>(desks, 1));
  found.notes.push_back(
      fmt::format("{} surfaces were found; {} are assessed (--surface names others)",
                  found.surfaces.size(), most_surfaces));
  found.surfaces.erase(last_desk - std::ptrdiff_t(dropped), last_desk);
  found.surfaces.resize(std::min(found.surfaces.size(), most_surfaces));
}

}  // namespace

FoundSurfaces find_surfaces(const PreparedScene& scene, const Vec3d& up, const std::string& profile,
                            double work_plane) {
  FoundSurfaces found;
  const std::vector<FlatFace> faces = flat_faces(scene.scene, up, nullptr);
  found.floors = find_floors(scene, up);
  found.surfaces = find_desks(scene, faces, found.floors, up, profile);
  const bool has_desks = !found.surfaces.empty();
  for (AssessedSurface s : found.floors) {
    if (!has_desks) {
      s.kind = SurfaceKind::work_plane;
      s.name += fmt::format(", {:.2f} m above", work_plane);
      s.profile = profile;
      s.corner += up * work_plane;
      s.above_floor = work_plane;
    }
    found.surfaces.push_back(std::move(s));
  }
  keep_most(found);
  return found;
}

namespace {

void add_node(const PreparedScene& scene, const Vec3d& up, const SurfaceRequest& r,
              const std::vector<AssessedSurface>& floors, std::vector<AssessedSurface>& out) {
  if (!has_node(scene.scene, r.node))
    throw UsageError("--surface: " + no_node_named(scene.scene, r.node));
  Vec3d n = up;
  std::vector<FlatFace> faces = flat_faces(scene.scene, n, &r.node);
  if (faces.empty()) {
    n = facing_of_node(scene.scene, r.node);
    if (length(n) > 0) faces = flat_faces(scene.scene, n, &r.node);
  }
  if (faces.empty())
    throw UsageError("--surface: '" + r.node + "' is not flat and has no face that looks upward");
  // A slab that is a floor is assessed within the walls of its rooms.
  std::vector<AssessedSurface> surfaces = floors_of_node(floors, faces);
  if (surfaces.empty())
    for (const FlatFace& f : faces) {
      if (f.area < 0.1 * faces.front().area) break;
      surfaces.push_back(surface_of(f, n, SurfaceKind::given, r.profile));
    }
  for (AssessedSurface& s : surfaces) {
    s.kind = SurfaceKind::given;
    s.profile = r.profile;
    s.name = r.name.empty() ? r.node : r.name;
    s.corner += s.normal() * r.lift;
    s.border = std::max(r.border, 0.0);
    if (s.width > 0 && s.height > 0) out.push_back(std::move(s));
  }
}

AssessedSurface rectangle(const SurfaceRequest& r) {
  AssessedSurface s;
  s.name = r.name;
  s.profile = r.profile;
  s.width = length(r.side_a);
  s.height = length(r.side_b);
  if (!(s.width > 0 && s.height > 0 && s.width <= 1e5 && s.height <= 1e5) ||
      std::abs(dot(r.side_a, r.side_b)) > 1e-3 * s.width * s.height)
    throw UsageError("surface '" + r.name +
                     "': its sides must be at right angles and have a length");
  s.along = r.side_a * (1 / s.width);
  const Vec3d n = normalize(cross(r.side_a, r.side_b));
  s.across = cross(n, s.along);
  s.corner = r.corner + n * r.lift;
  s.area = s.width * s.height;
  s.border = std::max(r.border, 0.0);
  const Vec2d a{0, 0}, b{s.width, 0}, c{s.width, s.height}, d{0, s.height};
  s.rim = {{a, b}, {b, c}, {c, d}, {d, a}};
  return s;
}

}  // namespace

FoundSurfaces asked_surfaces(const PreparedScene& scene, const Vec3d& up,
                             const std::vector<SurfaceRequest>& requests,
                             const std::string& profile) {
  FoundSurfaces found;
  found.floors = find_floors(scene, up);
  for (SurfaceRequest r : requests) {
    if (r.profile.empty()) r.profile = profile;
    if (r.node.empty())
      found.surfaces.push_back(rectangle(r));
    else
      add_node(scene, up, r, found.floors, found.surfaces);
  }
  for (AssessedSurface& s : found.surfaces) {
    constexpr double most = 30;
    s.above_floor = height_over(found.floors, s, up, most);
  }
  number_names(found.surfaces, up);
  keep_most(found);
  return found;
}

std::vector<uint8_t> covered_points(const PreparedScene& scene, const std::vector<Vec3d>& points,
                                    const Vec3d& up) {
  constexpr double touching = 0.03;  // m; no photometer fits below that
  const std::vector<Above> found = above(scene, points, up);
  std::vector<uint8_t> is_covered;
  for (const Above& a : found) is_covered.push_back(a.is_within || a.height < touching);
  return is_covered;
}

void lift_onto_rugs(const PreparedScene& scene, const Vec3d& up, std::vector<GridPoint>& points) {
  std::vector<Ray> rays;
  for (const GridPoint& p : points) rays.push_back(ray_from(scene, p.position + up * rug, -up));
  std::vector<Hit> hits(rays.size());
  scene.tracer.closest(rays, hits);
  std::vector<Vec3d> tops;
  std::vector<size_t> which;
  for (size_t i = 0; i < rays.size(); ++i) {
    constexpr double least = 1e-3;  // m; a nearer hit is the surface itself
    if (!hits[i].is_valid() || !(double(hits[i].t) < rug - least)) continue;
    const Surface s = surface_at(scene.scene, rays[i], hits[i]);
    if (!(dot(Vec3d(s.geometric_normal), up) > 0.99)) continue;
    which.push_back(i);
    tops.push_back(Vec3d(s.position) + scene.scene.origin);
  }
  const std::vector<uint8_t> is_covered = covered_points(scene, tops, up);
  for (size_t k = 0; k < which.size(); ++k)
    if (is_covered[k] == 0) points[which[k]].position = tops[k];
}

bool sees_beyond(const PreparedScene& scene, const std::vector<Vec3d>& points, const Vec3d& up) {
  constexpr size_t most_points = 64, rays_each = 256;
  Random random(1);
  const Frame frame{Vec3(up)};
  std::vector<Ray> rays;
  const size_t step = 1 + points.size() / most_points;
  for (size_t i = 0; i < points.size(); i += step)
    for (size_t k = 0; k < rays_each; ++k) {
      Vec3 d = sphere_from_square(random.next_vec2());
      d.z = std::abs(d.z);
      rays.push_back(ray_from(scene, points[i], Vec3d(frame.to_world(d))));
    }
  std::vector<Hit> hits(rays.size());
  scene.tracer.closest(rays, hits, Coherence::none, Meeting::no_panes);
  return std::any_of(hits.begin(), hits.end(), [](const Hit& h) { return !h.is_valid(); });
}

}  // namespace troffer
