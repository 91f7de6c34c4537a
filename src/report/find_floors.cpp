#include "report/find_floors.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

#include "report/plan_view.h"
#include "scene/mesh_in_world.h"

namespace troffer {

namespace {

constexpr double one_height = 2e-3;  // m; faces whose heights differ by less are one slab
constexpr double least_level = 0.99985, least_slope = 0.9397;  // cosines of 1 and 20 degrees
// Shares of level rays that hit something: within a room, and where half of the view is open.
constexpr double surely_enclosed = 0.9, least_enclosed = 0.6;

// Returns the unit normals of sloping faces with at least a floor's area, by falling area.
std::vector<Vec3d> slopes(const Scene& scene, const Vec3d& up) {
  constexpr size_t most = 8;
  constexpr double step = 5e-3;  // rounding of a normal's coordinates: .3 degrees
  std::map<std::array<int64_t, 3>, Vec3d> areas;
  for_each_mesh(scene, [&](uint32_t, const MeshInWorld& mesh) {
    for (size_t i = 0; i < mesh.size(); ++i) {
      const auto c = mesh.corners(i);
      const Vec3d a = cross(Vec3d(c[1]) - Vec3d(c[0]), Vec3d(c[2]) - Vec3d(c[0])) * 0.5;
      const double area = length(a), cosine = area > 0 ? dot(a, up) / area : 0;
      if (!(cosine >= least_slope && cosine < least_level)) continue;
      areas[{std::llround(a.x / area / step), std::llround(a.y / area / step),
             std::llround(a.z / area / step)}] += a;
    }
  });
  std::vector<Vec3d> normals;
  for (const auto& [key, a] : areas)
    if (length(a) >= least_floor) normals.push_back(a);
  std::stable_sort(normals.begin(), normals.end(),
                   [](const Vec3d& a, const Vec3d& b) { return length(a) > length(b); });
  if (normals.size() > most) normals.resize(most);
  for (Vec3d& n : normals) n = normalize(n);
  return normals;
}

// Adds the rooms on all faces with the normal n, plane by plane.
void add_rooms(const PreparedScene& scene, const Vec3d& n, const Vec3d& up,
               std::vector<Room>& rooms) {
  std::vector<FlatFace> faces = flat_faces(scene.scene, n, nullptr);
  std::stable_sort(faces.begin(), faces.end(),
                   [](const FlatFace& a, const FlatFace& b) { return a.height < b.height; });
  for (size_t i = 0; i < faces.size();) {
    std::vector<const FlatFace*> plane;
    double area = 0;
    const double first = faces[i].height;
    for (; i < faces.size() && faces[i].height < first + one_height; ++i) {
      plane.push_back(&faces[i]);
      area += faces[i].area;
    }
    if (area < least_floor) continue;
    for (Room& r : rooms_on(scene, plane, n, up)) rooms.push_back(std::move(r));
  }
}

bool is_over(const AssessedSurface& s, const AssessedSurface& floor) {
  const Vec3d from = middle_of(s) - floor.corner;
  const Vec2d p{dot(from, floor.along), dot(from, floor.across)};
  return lies_on(floor, p);
}

}  // namespace

double height_over(const std::vector<AssessedSurface>& floors, const AssessedSurface& s,
                   const Vec3d& up, double most) {
  double nearest = 0;
  for (const AssessedSurface& f : floors) {
    const double h = dot(middle_of(s) - f.corner, f.normal()) / dot(up, f.normal());
    if (h > one_height && h <= most && is_over(s, f) && (nearest == 0 || h < nearest)) nearest = h;
  }
  return nearest;
}

void number_names(std::vector<AssessedSurface>& surfaces, const Vec3d& up) {
  std::map<std::string, std::vector<AssessedSurface*>> by_name;
  for (AssessedSurface& s : surfaces) {
    if (s.name.empty()) s.name = name_of(s.kind);
    by_name[s.name].push_back(&s);
  }
  for (auto& [name, same] : by_name) {
    if (same.size() < 2) continue;
    sort_by_rows(same, up);
    for (size_t i = 0; i < same.size(); ++i) same[i]->name += fmt::format(" {}", i + 1);
  }
}

std::vector<AssessedSurface> find_floors(const PreparedScene& scene, const Vec3d& up) {
  std::vector<Room> rooms;
  add_rooms(scene, up, up, rooms);
  for (const Vec3d& n : slopes(scene.scene, up)) {
    std::vector<Room> sloping;
    add_rooms(scene, n, up, sloping);
    for (Room& r : sloping)
      if (r.around.roofed >= 0.5) rooms.push_back(std::move(r));
  }
  const auto any = [&](auto is) { return std::any_of(rooms.begin(), rooms.end(), is); };
  const bool has_roof = any([](const Room& r) { return r.around.roofed >= 0.5; });
  const bool has_walls = any([](const Room& r) { return r.around.enclosed >= surely_enclosed; });
  std::stable_sort(rooms.begin(), rooms.end(), [&](const Room& a, const Room& b) {
    return dot(a.floor.corner, up) < dot(b.floor.corner, up);
  });
  constexpr double storey = 1.5;  // m; a surface that is higher above a floor is another storey
  std::vector<AssessedSurface> floors;
  for (Room& r : rooms) {
    if (has_roof && r.around.roofed < 0.5) continue;
    if (has_walls && r.around.enclosed < least_enclosed) continue;
    const double h = height_over(floors, r.floor, up, storey);
    if (h > 0 && (h < rug || is_furniture(h, r.floor.area))) continue;
    r.floor.border = border_zone(r.floor.width, r.floor.height);
    r.floor.profile = "background";
    floors.push_back(std::move(r.floor));
  }
  std::stable_sort(
      floors.begin(), floors.end(),
      [](const AssessedSurface& a, const AssessedSurface& b) { return a.area > b.area; });
  number_names(floors, up);
  return floors;
}

std::vector<AssessedSurface> floors_of_node(const std::vector<AssessedSurface>& floors,
                                            const std::vector<FlatFace>& faces) {
  std::vector<AssessedSurface> own;
  for (const AssessedSurface& f : floors) {
    const Vec3d n = f.normal(), middle = middle_of(f);
    const bool is_own = std::any_of(faces.begin(), faces.end(), [&](const FlatFace& face) {
      return std::any_of(face.triangles.begin(), face.triangles.end(), [&](const auto& t) {
        if (std::abs(dot(t[0] - middle, n)) > 2 * one_height) return false;
        bool is_left = true;
        for (size_t k = 0; k < 3; ++k)
          is_left = is_left && dot(cross(t[(k + 1) % 3] - t[k], middle - t[k]), n) >= 0;
        return is_left;
      });
    });
    if (is_own) own.push_back(f);
  }
  return own;
}

}  // namespace troffer
