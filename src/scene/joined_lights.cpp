#include "scene/joined_lights.h"

#include <algorithm>
#include <array>
#include <map>

namespace troffer {

namespace {

using Corner = std::array<float, 3>;
Corner corner(const Vec3& p) {
  return {p.x + 0.0f, p.y + 0.0f, p.z + 0.0f};  // turns -0 into 0
}

// Geometry of a light and the sides it emits from, as a list of numbers. Lights with equal lists
// are joined.
using Place = std::vector<float>;

void append(const std::vector<Corner>& corners, Place& out) {
  for (const Corner& c : corners) out.insert(out.end(), c.begin(), c.end());
}

// Starts the outline at its smallest corner. The direction of a one-sided outline shows the front
// and is kept; that of a two-sided one is normalized.
std::vector<Corner> canonical(std::vector<Corner> corners, bool is_two_sided) {
  std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
  if (!is_two_sided) return corners;
  std::vector<Corner> reversed = corners;
  std::reverse(reversed.begin() + 1, reversed.end());
  return std::min(corners, reversed);
}

Place place_of(const Scene& scene, const Light& e) {
  Place out{float(e.kind), e.is_two_sided ? 1.0f : 0.0f};
  std::vector<Corner> corners;
  switch (e.kind) {
    case LightKind::sphere: {
      const Sphere& s = scene.spheres[e.geometry];
      append({corner(s.centre)}, out);
      out.push_back(s.radius);
      out.push_back(s.is_inside_out ? 1.0f : 0.0f);
      break;
    }
    case LightKind::disk: {
      const Disk& d = scene.disks[e.geometry];
      Corner n = corner(d.normal);
      if (e.is_two_sided) n = std::min(n, corner(-d.normal));
      append({corner(d.centre), n}, out);
      out.push_back(d.radius);
      break;
    }
    case LightKind::polygon:
      for (const Vec3& p : e.polygon) corners.push_back(corner(p));
      if (!corners.empty()) append(canonical(std::move(corners), e.is_two_sided), out);
      break;
    case LightKind::point:
    case LightKind::spot:
    case LightKind::distant:
    case LightKind::environment:
    case LightKind::sky:
    case LightKind::sun:
      break;  // without surface
    case LightKind::mesh: {
      const Mesh& mesh = scene.meshes[e.geometry];
      std::vector<std::vector<Corner>> all;
      for (const uint32_t t : e.triangles) {
        corners.clear();
        for (const uint32_t v : mesh.triangles[t]) corners.push_back(corner(mesh.positions[v]));
        all.push_back(canonical(corners, e.is_two_sided));
      }
      std::sort(all.begin(), all.end());
      for (const std::vector<Corner>& c : all) append(c, out);
    }
  }
  return out;
}

bool may_be_joined(const Light& e) {
  return has_surface(e.kind) && e.texture == no_texture && !e.is_alpha_masked && e.web == no_web;
}

// Index of the first light in the same place, for each light; its own index if it is the first.
std::vector<uint32_t> first_in_place(const Scene& scene) {
  std::map<Place, uint32_t> places;
  std::vector<uint32_t> first(scene.lights.size());
  for (uint32_t i = 0; i < scene.lights.size(); ++i)
    first[i] = may_be_joined(scene.lights[i])
                   ? places.try_emplace(place_of(scene, scene.lights[i]), i).first->second
                   : i;
  return first;
}

// Removes the triangles of removed lights. The caller rebuilds the triangle lists of the others.
void remove_triangles(Mesh& mesh, const std::vector<uint8_t>& is_gone) {
  size_t kept = 0;
  for (size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (mesh.lights[t] >= 0 && is_gone[size_t(mesh.lights[t])] != 0) continue;
    mesh.triangles[kept] = mesh.triangles[t];
    mesh.lights[kept++] = mesh.lights[t];
  }
  mesh.triangles.resize(kept);
  mesh.lights.resize(kept);
}

template <class Body>
void remove_bodies(std::vector<Body>& bodies, LightKind kind, const std::vector<uint8_t>& is_gone,
                   std::vector<Light>& lights) {
  size_t kept = 0;
  for (Body& b : bodies) {
    if (b.light >= 0 && is_gone[size_t(b.light)] != 0) continue;
    if (b.light >= 0 && lights[size_t(b.light)].kind == kind)
      lights[size_t(b.light)].geometry = uint32_t(kept);
    bodies[kept++] = b;
  }
  bodies.resize(kept);
}

void remove_lights(Scene& scene, const std::vector<uint8_t>& is_gone) {
  remove_bodies(scene.spheres, LightKind::sphere, is_gone, scene.lights);
  remove_bodies(scene.disks, LightKind::disk, is_gone, scene.lights);
  std::vector<int32_t> renumbered(scene.lights.size(), no_light);
  std::vector<Light> kept;
  for (size_t i = 0; i < scene.lights.size(); ++i) {
    if (is_gone[i] != 0) continue;
    renumbered[i] = int32_t(kept.size());
    kept.push_back(std::move(scene.lights[i]));
    kept.back().triangles.clear();  // rebuilt from the meshes below
  }
  scene.lights = std::move(kept);
  const auto renumber = [&](int32_t& e) {
    if (e >= 0) e = renumbered[size_t(e)];
  };
  for (Sphere& s : scene.spheres) renumber(s.light);
  for (Disk& d : scene.disks) renumber(d.light);
  for (Mesh& m : scene.meshes) {
    if (m.lights.empty()) continue;
    remove_triangles(m, is_gone);
    std::for_each(m.lights.begin(), m.lights.end(), renumber);
    for (uint32_t t = 0; t < m.lights.size(); ++t)
      if (m.lights[t] >= 0) scene.lights[size_t(m.lights[t])].triangles.push_back(t);
  }
}

}  // namespace

Scene with_joined_lights(Scene scene) {
  const std::vector<uint32_t> first = first_in_place(scene);
  std::vector<uint8_t> is_gone(first.size(), 0);
  for (uint32_t i = 0; i < first.size(); ++i) {
    if (first[i] == i) continue;
    is_gone[i] = 1;
    scene.lights[first[i]].radiance += scene.lights[i].radiance;
    scene.warnings.add("lights in exactly the same place are joined into one");
  }
  if (std::find(is_gone.begin(), is_gone.end(), 1) == is_gone.end()) return scene;
  remove_lights(scene, is_gone);
  return scene;
}

}  // namespace troffer
