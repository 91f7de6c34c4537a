#include "radiosity/patch_surface.h"

#include <algorithm>

#include "base/box.h"
#include "radiosity/subdivide.h"

namespace troffer {

namespace {

// Rotates the corners so that corner 0, the apex of a fan, lies opposite the longest edge. The fan
// is then least slanted.
void begin_opposite_longest_edge(std::vector<Vec3>& triangle) {
  const size_t apex = (longest_edge(std::span<const Vec3, 3>(triangle)).number + 2) % 3;
  std::rotate(triangle.begin(), triangle.begin() + std::ptrdiff_t(apex), triangle.end());
}

Vec3 middle(const std::vector<Vec3>& polygon) {
  Vec3 sum;
  for (const Vec3& p : polygon) sum += p;
  return sum / float(polygon.size());
}

void sort_along_longest_extent(std::vector<std::vector<Vec3>>& polygons) {
  Box box;
  for (const auto& polygon : polygons)
    for (const Vec3& p : polygon) box.grow(p);
  const Vec3 e = box.extent();
  const size_t axis = e.x >= e.y && e.x >= e.z ? 0 : e.y >= e.z ? 1 : 2;
  std::stable_sort(polygons.begin(), polygons.end(),
                   [&](const auto& a, const auto& b) { return middle(a)[axis] < middle(b)[axis]; });
}

}  // namespace

SourceSurface patch_surface(const RadiosityMesh& mesh, uint32_t patch) {
  const Patch& from = mesh.patches[patch];
  const Sheet& sheet = mesh.sheets[from.sheet];
  std::vector<std::vector<Vec3>> polygons;
  for (uint32_t i = sheet.first_piece; i < sheet.last_piece; ++i) {
    const auto [first, count] = mesh.pieces[i];
    const auto begin = mesh.piece_corners.begin() + first;
    std::vector<Vec3> corners(begin, begin + count);
    if (from.is_back) std::reverse(corners.begin(), corners.end());
    if (count == 3) begin_opposite_longest_edge(corners);
    polygons.push_back(std::move(corners));
  }
  sort_along_longest_extent(polygons);
  return SourceSurface(polygons);
}

Vec3 ray_target(const RadiosityMesh& mesh, uint32_t patch, const SourcePoint& at) {
  const Sheet& sheet = mesh.sheets[mesh.patches[patch].sheet];
  Vec3 point = at.point, normal = at.normal;
  if (sheet.round_radius > 0) {
    const Vec3 from_centre = normalize(point - sheet.round_centre);
    normal = dot(from_centre, normal) < 0 ? -from_centre : from_centre;
    point = sheet.round_centre + from_centre * sheet.round_radius;
  }
  return point + normal * sheet.offset;
}

}  // namespace troffer
