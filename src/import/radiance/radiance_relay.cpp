#include "import/radiance/radiance_relay.h"

#include "import/polygon.h"

namespace troffer {

namespace {

// Returns a vector along the normal, whose length is twice the area.
Vec3d double_area(const std::vector<Vec3d>& corners) {
  Vec3d sum;
  for (size_t i = 2; i < corners.size(); ++i)
    sum = sum + cross(corners[i - 1] - corners[0], corners[i] - corners[0]);
  return sum;
}

bool is_convex(const std::vector<Vec3d>& corners, const Vec3d& area) {
  constexpr double rounding = 1e-9;  // of products of double precision, with a margin
  for (size_t i = 0, n = corners.size(); i < n; ++i) {
    const Vec3d &a = corners[i], &b = corners[(i + 1) % n], &c = corners[(i + 2) % n];
    if (dot(cross(b - a, c - b), area) < -rounding * length_squared(area)) return false;
  }
  return true;
}

void add_one(const std::vector<Vec3d>& corners, const Vec3d& area, const Rgb& reflectance,
             Scene& scene, PlacedBounds& bounds) {
  LightRelay relay;
  for (const Vec3d& c : corners) relay.outline.emplace_back(c - scene.origin);
  for (size_t i = 2; i < corners.size(); ++i)
    bounds.add_triangle(corners[0], corners[i - 1], corners[i]);
  relay.normal = Vec3(normalize(area));
  relay.reflectance = reflectance;
  scene.relays.push_back(std::move(relay));
}

}  // namespace

void add_radiance_relays(const std::vector<Vec3d>& corners, const Rgb& reflectance, Scene& scene,
                         PlacedBounds& bounds) {
  const Vec3d area = double_area(corners);
  if (!(length_squared(area) > 0)) return;
  if (is_convex(corners, area)) {
    add_one(corners, area, reflectance, scene, bounds);
    return;
  }
  std::vector<Vec3> points;
  for (const Vec3d& c : corners) points.emplace_back(c - corners[0]);
  std::vector<Triangle> triangles;
  triangulate(points, triangles);
  for (const Triangle& t : triangles) {
    const std::vector<Vec3d> piece{corners[t[0]], corners[t[1]], corners[t[2]]};
    const Vec3d half = double_area(piece);
    if (length_squared(half) > 0) add_one(piece, half, reflectance, scene, bounds);
  }
}

}  // namespace troffer
