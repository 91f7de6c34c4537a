#include "report/find_surfaces.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "base/error.h"
#include "base/random.h"
#include "base/warp.h"
#include "report/flat_faces.h"
#include "scene/names.h"
#include "trace/surface.h"

namespace troffer {

namespace {

constexpr size_t most_surfaces = 24;
constexpr double least_floor = 1.5, least_desk = 0.25, least_side = 0.35;  // m², m², m
constexpr double headroom = 1.9, desk_room = 0.5;                          // m
constexpr double desk_low = 0.6, desk_high = 0.95, tallest_desk = 1.4;     // m over the floor

Ray ray_from(const PreparedScene& scene, const Vec3d& point, const Vec3d& direction) {
  const Vec3 p(point - scene.scene.origin);
  const Vec3 reach = abs(p);
  Ray ray;
  ray.direction = Vec3(direction);
  ray.origin =
      p + ray.direction *
              std::max(1e-5f, 4 * ray_offset(std::max(reach.x, std::max(reach.y, reach.z))));
  return ray;
}

struct Above {
  double height = 0;  // m; infinite: nothing is there
  bool is_from_behind = false;
};

std::vector<Above> above(const PreparedScene& scene, const std::vector<Vec3d>& points,
                         const Vec3d& up) {
  std::vector<Ray> rays;
  for (const Vec3d& p : points) rays.push_back(ray_from(scene, p, up));
  std::vector<Hit> hits(rays.size());
  scene.tracer.closest(rays, hits);
  std::vector<Above> found(points.size());
  for (size_t i = 0; i < rays.size(); ++i) {
    found[i].height = std::numeric_limits<double>::infinity();
    if (!hits[i].is_valid()) continue;
    found[i].height = double(hits[i].t);
    const Surface s = surface_at(scene.scene, rays[i], hits[i]);
    found[i].is_from_behind = dot(s.geometric_normal, rays[i].direction) > 0;
  }
  return found;
}

std::vector<Vec3d> places_on(const AssessedSurface& s) {
  std::vector<Vec3d> places;
  const SurfaceGrid grid = grid_of(s);
  const size_t step = 1 + grid.points.size() / 64;
  for (size_t i = 0; i < grid.points.size(); i += step) places.push_back(grid.points[i].position);
  return places;
}

struct Room {
  double clear = 0, roofed = 0;  // shares of places: with so much room above; of them, with a roof
};

Room room_above(const PreparedScene& scene, const AssessedSurface& s, const Vec3d& up,
                double height) {
  const std::vector<Above> found = above(scene, places_on(s), up);
  Room room;
  for (const Above& a : found) {
    const bool is_clear = a.height >= height && !a.is_from_behind;
    room.clear += is_clear ? 1 : 0;
    room.roofed += is_clear && std::isfinite(a.height) ? 1 : 0;
  }
  room.clear /= double(found.size());
  room.roofed /= double(found.size());
  return room;
}

// Whether the middle of a surface lies over another one, seen from above.
bool lies_over(const AssessedSurface& s, const AssessedSurface& floor) {
  const Vec3d from = s.place({s.width / 2, s.height / 2}) - floor.corner;
  const double x = dot(from, floor.along), y = dot(from, floor.across);
  return x >= 0 && y >= 0 && x <= floor.width && y <= floor.height;
}

// The highest of the floors that it lies over, at most so far below; its height over that, or 0.
double height_over(const std::vector<AssessedSurface>& floors, const AssessedSurface& s,
                   const Vec3d& up, double most) {
  double nearest = 0;
  for (const AssessedSurface& f : floors) {
    const double h = dot(s.corner - f.corner, up);
    if (h > 0.02 && h <= most && lies_over(s, f) && (nearest == 0 || h < nearest)) nearest = h;
  }
  return nearest;
}

AssessedSurface surface_of(const FlatFace& face, const Vec3d& n, SurfaceKind kind,
                           const std::string& profile) {
  AssessedSurface s = surface_of_triangles(face.triangles, n);
  s.name = face.name;
  s.kind = kind;
  s.profile = profile;
  return s;
}

// Names that repeat, or are missing, get numbers.
void number_names(std::vector<AssessedSurface>& surfaces) {
  std::map<std::string, int> count, next;
  for (AssessedSurface& s : surfaces) {
    const bool is_named = !s.name.empty();
    if (!is_named) s.name = name_of(s.kind);
    ++count[s.name];
  }
  for (AssessedSurface& s : surfaces)
    if (count[s.name] > 1) s.name += fmt::format(" {}", ++next[s.name]);
}

std::vector<AssessedSurface> find_floors(const PreparedScene& scene, std::vector<FlatFace> faces,
                                         const Vec3d& up) {
  std::erase_if(faces, [](const FlatFace& f) { return f.area < least_floor; });
  std::stable_sort(faces.begin(), faces.end(),
                   [](const FlatFace& a, const FlatFace& b) { return a.height < b.height; });
  struct Candidate {
    AssessedSurface surface;
    Room room;
  };
  std::vector<Candidate> candidates;
  bool has_roof = false;
  for (const FlatFace& f : faces) {
    Candidate c{surface_of(f, up, SurfaceKind::floor, "background"), {}};
    if (std::min(c.surface.width, c.surface.height) < least_side) continue;
    c.room = room_above(scene, c.surface, up, headroom);
    has_roof = has_roof || c.room.roofed >= 0.5;
    candidates.push_back(std::move(c));
  }
  std::vector<AssessedSurface> floors;
  for (Candidate& c : candidates) {
    if ((has_roof ? c.room.roofed : c.room.clear) < 0.5) continue;
    const double h = height_over(floors, c.surface, up, tallest_desk);
    if (h >= desk_low) continue;
    c.surface.border = border_zone(c.surface.width, c.surface.height);
    floors.push_back(std::move(c.surface));
  }
  std::stable_sort(
      floors.begin(), floors.end(),
      [](const AssessedSurface& a, const AssessedSurface& b) { return a.area > b.area; });
  number_names(floors);
  return floors;
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
    if (room_above(scene, s, up, desk_room).clear < 0.5) continue;
    desks.push_back(std::move(s));
  }
  number_names(desks);
  return desks;
}

void keep_most(FoundSurfaces& found) {
  if (found.surfaces.size() <= most_surfaces) return;
  found.notes.push_back(
      fmt::format("{} surfaces were found; the first {} are assessed (--surface names others)",
                  found.surfaces.size(), most_surfaces));
  found.surfaces.resize(most_surfaces);
}

}  // namespace

FoundSurfaces find_surfaces(const PreparedScene& scene, const Vec3d& up, const std::string& profile,
                            double work_plane) {
  FoundSurfaces found;
  const std::vector<FlatFace> faces = flat_faces(scene.scene, up, nullptr);
  found.floors = find_floors(scene, faces, up);
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
              std::vector<AssessedSurface>& out) {
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
  for (const FlatFace& f : faces) {
    if (f.area < 0.1 * faces.front().area) break;
    AssessedSurface s = surface_of(f, n, SurfaceKind::given, r.profile);
    s.name = r.name.empty() ? r.node : r.name;
    s.corner += n * r.lift;
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
  found.floors = find_floors(scene, flat_faces(scene.scene, up, nullptr), up);
  for (SurfaceRequest r : requests) {
    if (r.profile.empty()) r.profile = profile;
    if (r.node.empty())
      found.surfaces.push_back(rectangle(r));
    else
      add_node(scene, up, r, found.surfaces);
  }
  for (AssessedSurface& s : found.surfaces) {
    constexpr double most = 30;
    s.above_floor = height_over(found.floors, s, up, most);
  }
  number_names(found.surfaces);
  keep_most(found);
  return found;
}

std::vector<uint8_t> covered_points(const PreparedScene& scene, const std::vector<Vec3d>& points,
                                    const Vec3d& up) {
  constexpr double touching = 0.03;  // m: no photometer fits under it
  const std::vector<Above> found = above(scene, points, up);
  std::vector<uint8_t> is_covered;
  for (const Above& a : found) is_covered.push_back(a.is_from_behind || a.height < touching);
  return is_covered;
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
