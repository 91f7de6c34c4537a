#include "render/cell_pilot.h"

#include <algorithm>
#include <cmath>

#include "base/frame.h"
#include "base/random.h"
#include "base/units.h"
#include "base/warp.h"
#include "integrate/purposes.h"
#include "trace/surface.h"

namespace troffer {

namespace {

constexpr uint32_t rays_of_pilot = 8192;
constexpr uint32_t places_of_pilot = 16384;

// A surface, and where it ends in the sum of all areas.
struct Area {
  double end = 0;
  uint32_t mesh = 0, triangle = 0;  // … or of spheres and disks, their number behind the meshes
};

struct Corners {
  Vec3 a, b, c;
};

Corners corners_of(const Scene& scene, const Area& area) {
  const Mesh& m = scene.meshes[area.mesh];
  const Triangle& t = m.triangles[area.triangle];
  return {m.positions[t[0]], m.positions[t[1]], m.positions[t[2]]};
}

std::vector<Area> areas_of(const Scene& scene) {
  std::vector<Area> areas;
  double sum = 0;
  const auto add = [&](double area, uint32_t mesh, uint32_t triangle) {
    if (!(area > 0) || !std::isfinite(area)) return;
    sum += area;
    areas.push_back({sum, mesh, triangle});
  };
  auto number = uint32_t(scene.meshes.size());
  for (uint32_t m = 0; m < scene.meshes.size(); ++m)
    for (uint32_t t = 0; t < scene.meshes[m].triangles.size(); ++t) {
      const Corners k = corners_of(scene, {0, m, t});
      add(0.5 * double(length(cross(k.b - k.a, k.c - k.a))), m, t);
    }
  for (const Sphere& s : scene.spheres) add(4 * pi * sqr(double(s.radius)), number++, 0);
  for (const Disk& d : scene.disks) add(pi * sqr(double(d.radius)), number++, 0);
  return areas;
}

// A point of it, and the normal there.
void sample(const Scene& scene, const Area& area, const Vec2& u, Vec3& position, Vec3& normal) {
  size_t i = area.mesh;
  if (i < scene.meshes.size()) {
    const Corners k = corners_of(scene, area);
    const Vec2 at = triangle_from_square(u);
    position = k.a + (k.b - k.a) * at.x + (k.c - k.a) * at.y;
    normal = normalize(cross(k.b - k.a, k.c - k.a));
    return;
  }
  i -= scene.meshes.size();
  if (i < scene.spheres.size()) {
    normal = sphere_from_square(u);
    position = scene.spheres[i].centre + normal * scene.spheres[i].radius;
    return;
  }
  const Disk& disk = scene.disks[i - scene.spheres.size()];
  const Vec2 at = disk_from_square(u);
  const Frame frame(disk.normal);
  normal = disk.normal;
  position = disk.centre + frame.to_world({at.x * disk.radius, at.y * disk.radius, 0});
}

}  // namespace

CellPilot picture_pilot(const ViewingCamera& camera, const ImageSize& size, uint64_t seed) {
  CellPilot pilot;
  const uint64_t stream = hash_of(seed, uint64_t{0x7069'6374});
  for (uint32_t i = 0; i < rays_of_pilot; ++i) {
    const SobolGroup random(stream, purpose_camera, i);
    const Vec2 at = random.get2(0);
    pilot.viewing.rays.push_back(
        camera.ray({at.x * float(size.width), at.y * float(size.height)}, random.get2(2)));
    pilot.viewing.streams.push_back(stream);
    pilot.viewing.samples.push_back(i);
  }
  return pilot;
}

CellPilot surfaces_pilot(const PreparedScene& scene, uint64_t seed) {
  CellPilot pilot;
  const std::vector<Area> areas = areas_of(scene.scene);
  if (areas.empty()) return pilot;
  const Box box = bounds(scene.scene);
  const uint64_t stream = hash_of(seed, uint64_t{0x7375'7266});
  for (uint32_t i = 0; i < places_of_pilot; ++i) {
    const SobolGroup random(stream, purpose_camera, i);
    const double at = (double(i) + 0.5) / places_of_pilot * areas.back().end;
    const auto area = std::lower_bound(areas.begin(), areas.end(), at,
                                       [](const Area& a, double x) { return a.end < x; });
    Vec3 position, n;
    sample(scene.scene, area == areas.end() ? areas.back() : *area, random.get2(0), position, n);
    if (i % 2 == 1) n = -n;
    if (!is_finite(position) || !is_finite(n)) continue;
    pilot.places.push_back({position, n, n, offset_of_point(position, box)});
  }
  return pilot;
}

float offset_of_point(const Vec3& position, const Box& scene) {
  const Vec3 p = abs(position);
  return std::max(ray_offset(std::max({p.x, p.y, p.z})), std::min(1e-5f, 1e-6f * scene.diagonal()));
}

}  // namespace troffer
