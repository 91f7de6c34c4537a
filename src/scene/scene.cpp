#include "scene/scene.h"

#include <algorithm>

#include "base/error.h"
#include "base/parallel.h"
#include "scene/names.h"

namespace troffer {

size_t triangle_count(const Scene& scene) {
  size_t n = 0;
  for (const Mesh& m : scene.meshes) n += m.triangles.size();
  for (const Instance& i : scene.instances) n += scene.instanced_meshes[i.mesh].triangles.size();
  return n;
}

size_t stored_triangle_count(const Scene& scene) {
  size_t n = 0;
  for (const Mesh& m : scene.meshes) n += m.triangles.size();
  for (const Mesh& m : scene.instanced_meshes) n += m.triangles.size();
  return n;
}

// Bounds of the vertices that triangles use; runs on all cores.
static Box bounds_of_triangles(const Mesh& mesh) {
  constexpr size_t at_once = size_t(1) << 16;
  std::vector<Box> parts(mesh.triangles.size() / at_once + 1);
  parallel_pieces(mesh.triangles.size(), at_once, [&](size_t first, size_t end) {
    Box own;
    for (size_t i = first; i < end; ++i)
      for (const uint32_t v : mesh.triangles[i]) own.grow(mesh.positions[v]);
    parts[first / at_once] = own;
  });
  Box box;
  for (const Box& part : parts) box.grow(part);
  return box;
}

Box bounds(const Scene& scene) {
  Box box;
  for (const Mesh& m : scene.meshes) box.grow(bounds_of_triangles(m));
  for (const Instance& i : scene.instances) box.grow(i.bounds);
  for (const Sphere& s : scene.spheres) {
    box.grow(s.centre - Vec3{s.radius});
    box.grow(s.centre + Vec3{s.radius});
  }
  for (const Disk& d : scene.disks) {
    // Half extent of a disk along axis a: r sqrt(1 - n_a²).
    Vec3 half;
    for (size_t a = 0; a < 3; ++a)
      half[a] = d.radius * std::sqrt(std::max(0.0f, 1 - d.normal[a] * d.normal[a]));
    box.grow(d.centre - half);
    box.grow(d.centre + half);
  }
  return box;
}

Boxd bounds_in_file(const Scene& scene) {
  const Box box = bounds(scene);
  return {Vec3d(box.lower) + scene.origin, Vec3d(box.upper) + scene.origin};
}

Scene with_only_lights(Scene scene, const std::vector<std::string>& names) {
  for (const std::string& name : names)
    if (std::none_of(scene.lights.begin(), scene.lights.end(),
                     [&](const Light& e) { return e.name == name; }))
      throw UsageError(no_light_named(scene, name));

  std::vector<int32_t> renumbered(scene.lights.size(), no_light);
  std::vector<Light> kept;
  for (size_t i = 0; i < scene.lights.size(); ++i) {
    if (std::find(names.begin(), names.end(), scene.lights[i].name) == names.end()) continue;
    renumbered[i] = int32_t(kept.size());
    kept.push_back(std::move(scene.lights[i]));
  }
  scene.lights = std::move(kept);
  const auto renumber = [&](int32_t& e) {
    if (e >= 0) e = renumbered[size_t(e)];
  };
  for (Mesh& m : scene.meshes) std::for_each(m.lights.begin(), m.lights.end(), renumber);
  for (Sphere& s : scene.spheres) renumber(s.light);
  for (Disk& d : scene.disks) renumber(d.light);
  return scene;
}

Camera without_fisheye(Camera camera) {
  if (camera.kind != CameraKind::fisheye) return camera;
  camera.kind = CameraKind::perspective;
  camera.half_extent = std::min(std::tan(std::min(camera.half_extent, 1.0f)), 1.0f);
  camera.has_screen_window = false;
  return camera;
}

}  // namespace troffer
