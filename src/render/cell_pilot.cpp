#include "render/cell_pilot.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/frame.h"
#include "base/random.h"
#include "base/streams.h"
#include "base/units.h"
#include "base/warp.h"
#include "scene/mesh_in_world.h"
#include "trace/surface.h"
#include "transport/purposes.h"

namespace troffer {

namespace {

constexpr uint32_t rays_of_pilot = 8192;
constexpr uint32_t places_of_pilot = 16384;

// A surface, and the cumulative area up to its end.
struct Area {
  double end = 0;
  uint32_t geometry = 0, primitive = 0;  // as in Hit; primitive is 0 for an instance
};

double area_of(const std::array<Vec3, 3>& k) {
  return 0.5 * double(length(cross(k[1] - k[0], k[2] - k[0])));
}

// Returns the cumulative areas of a mesh's triangles.
std::vector<double> area_sums(const Mesh& mesh) {
  const MeshInWorld as_it_is(mesh);
  std::vector<double> sums;
  sums.reserve(mesh.triangles.size());
  double sum = 0;
  for (size_t t = 0; t < mesh.triangles.size(); ++t) {
    const double area = area_of(as_it_is.corners(t));
    sums.push_back(sum += area > 0 && std::isfinite(area) ? area : 0);
  }
  return sums;
}

struct Areas {
  std::vector<Area> all;
  std::vector<std::vector<double>> of_instanced;  // per instanced mesh, in its own space
};

// Within an instance, triangles are weighted by their area in mesh space, even if the transform is
// not uniform: the distribution of places need not be exact.
Areas areas_of(const Scene& scene) {
  Areas areas;
  double sum = 0;
  const auto add = [&](double area, uint32_t geometry, uint32_t primitive) {
    if (!(area > 0) || !std::isfinite(area)) return;
    sum += area;
    areas.all.push_back({sum, geometry, primitive});
  };
  for (const Mesh& mesh : scene.instanced_meshes) areas.of_instanced.push_back(area_sums(mesh));
  const auto meshes = uint32_t(scene.meshes.size());
  for (uint32_t m = 0; m < meshes; ++m) {
    const MeshInWorld mesh = mesh_at(scene, m);
    for (uint32_t t = 0; t < mesh.size(); ++t) add(area_of(mesh.corners(t)), m, t);
  }
  uint32_t number = 0;
  for (const Sphere& s : scene.spheres) add(4 * pi * sqr(double(s.radius)), meshes, number++);
  number = 0;
  for (const Disk& d : scene.disks) add(pi * sqr(double(d.radius)), meshes + 1, number++);
  number = first_instance(scene);
  for (const Instance& i : scene.instances)
    add(areas.of_instanced[i.mesh].back() *
            std::pow(std::abs(i.world_from_mesh.determinant()), 2.0 / 3),
        number++, 0);
  return areas;
}

// Returns the surface at a cumulative area; for an instance also its triangle.
Area surface_at_area(const Scene& scene, const Areas& areas, double at) {
  auto found = std::lower_bound(areas.all.begin(), areas.all.end(), at,
                                [](const Area& a, double x) { return a.end < x; });
  if (found == areas.all.end()) --found;
  Area area = *found;
  if (!is_instance(scene, area.geometry)) return area;
  const double start = found == areas.all.begin() ? 0 : (found - 1)->end;
  const std::vector<double>& sums =
      areas.of_instanced[scene.instances[area.geometry - first_instance(scene)].mesh];
  const double share = (at - start) / (area.end - start) * sums.back();
  const auto triangle = std::lower_bound(sums.begin(), sums.end() - 1, share);
  area.primitive = uint32_t(triangle - sums.begin());
  return area;
}

// Samples a point on it, and the normal there.
void sample(const Scene& scene, const Area& area, const Vec2& u, Vec3& position, Vec3& normal) {
  if (is_mesh(scene, area.geometry)) {
    const auto [a, b, c] = mesh_at(scene, area.geometry).corners(area.primitive);
    const Vec2 at = triangle_from_square(u);
    position = a + (b - a) * at.x + (c - a) * at.y;
    normal = normalize(cross(b - a, c - a));
    return;
  }
  if (area.geometry == scene.meshes.size()) {
    const Sphere& sphere = scene.spheres[area.primitive];
    normal = sphere_from_square(u);
    position = sphere.centre + normal * sphere.radius;
    return;
  }
  const Disk& disk = scene.disks[area.primitive];
  const Vec2 at = disk_from_square(u);
  const Frame frame(disk.normal);
  normal = disk.normal;
  position = disk.centre + frame.to_world({at.x * disk.radius, at.y * disk.radius, 0});
}

}  // namespace

CellPilot picture_pilot(const ViewingCamera& camera, const ImageSize& size, uint64_t seed) {
  CellPilot pilot;
  const uint64_t stream = hash_of(seed, stream::picture_pilot);
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
  const Areas areas = areas_of(scene.scene);
  if (areas.all.empty()) return pilot;
  const Box box = bounds(scene.scene);
  const uint64_t stream = hash_of(seed, stream::surfaces_pilot);
  for (uint32_t i = 0; i < places_of_pilot; ++i) {
    const SobolGroup random(stream, purpose_camera, i);
    const double at = (double(i) + 0.5) / places_of_pilot * areas.all.back().end;
    Vec3 position, n;
    sample(scene.scene, surface_at_area(scene.scene, areas, at), random.get2(0), position, n);
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
