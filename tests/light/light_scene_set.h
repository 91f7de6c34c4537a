// Test scenes with one light each, tilted and moved away from the origin. Pose converts points to
// and from the light's own coordinates.
#pragma once

#include <string>
#include <vector>

#include "base/frame.h"
#include "base/random.h"
#include "light/light_primitive.h"
#include "light/source_surface.h"
#include "scene/scene.h"

namespace troffer::test {

// Rounds to single precision. Not inlined, because GCC 12's vectorizer drops the rounding in a
// conversion to float and straight back to double.
[[gnu::noinline]] inline Vec3 rounded(const Vec3d& v) {
  return Vec3(v);
}

// World = place + x t + y b + z n. Lights lie in z = 0 with their front towards +z.
struct Pose {
  Framed frame{normalize(Vec3d{0.3, -0.7, 0.4})};
  Vec3d place{1.5, -0.75, 2.25};
  Vec3 world(const Vec3d& p) const { return rounded(place + frame.to_world(p)); }
  Vec3d local(const Vec3& p) const { return frame.to_local(Vec3d(p) - place); }
};

inline Scene polygon_scene(const std::vector<Vec3d>& local, bool is_two_sided = false,
                           const Pose& pose = {}) {
  Scene s;
  s.materials.emplace_back();
  Mesh m;
  Light e;
  e.name = "light";
  e.radiance = Rgb{2};
  e.is_two_sided = is_two_sided;
  for (const Vec3d& p : local) {
    m.positions.push_back(pose.world(p));
    e.polygon.push_back(m.positions.back());
  }
  for (uint32_t i = 1; i + 1 < local.size(); ++i) {
    e.triangles.push_back(uint32_t(m.triangles.size()));
    m.triangles.push_back({0, i, i + 1});
  }
  m.lights.assign(m.triangles.size(), 0);
  s.meshes.push_back(m);
  s.lights.push_back(e);
  return s;
}

inline Scene mesh_scene(const std::vector<Vec3d>& local, const std::vector<Triangle>& triangles,
                        const Pose& pose = {}) {
  Scene s = polygon_scene(local, false, pose);
  Mesh& m = s.meshes[0];
  Light& e = s.lights[0];
  m.triangles = triangles;
  m.lights.assign(triangles.size(), 0);
  for (const Vec3d& p : local) m.uvs.push_back({float(p.x), float(p.y)});
  e.kind = LightKind::mesh;
  e.polygon.clear();
  e.triangles.clear();
  for (uint32_t i = 0; i < triangles.size(); ++i) e.triangles.push_back(i);
  return s;
}

inline Scene disk_scene(double radius, bool is_two_sided = false, const Pose& pose = {}) {
  Scene s;
  s.materials.emplace_back();
  s.disks.push_back({pose.world({}), Vec3(pose.frame.normal), float(radius), 0, 0});
  Light e;
  e.kind = LightKind::disk;
  e.radiance = Rgb{2};
  e.is_two_sided = is_two_sided;
  s.lights.push_back(e);
  return s;
}

inline Scene sphere_scene(double radius, bool is_inside_out = false, bool is_two_sided = false,
                          const Pose& pose = {}) {
  Scene s;
  s.materials.emplace_back();
  s.spheres.push_back({pose.world({}), float(radius), is_inside_out, 0, 0});
  Light e;
  e.kind = LightKind::sphere;
  e.radiance = Rgb{2};
  e.is_two_sided = is_two_sided;
  s.lights.push_back(e);
  return s;
}

struct NamedScene {
  std::string name;
  Scene scene;
};

// Flat lights about one unit wide. The disk is centred on (0,0), the others on about (0.5, 0.5).
inline std::vector<NamedScene> flat_scenes(bool is_two_sided = false) {
  std::vector<NamedScene> all;
  const auto add = [&](const char* name, Scene s) {
    s.lights[0].is_two_sided = is_two_sided;
    all.push_back({name, std::move(s)});
  };
  add("square", polygon_scene({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}));
  add("strip", polygon_scene({{0, 0, 0}, {1.5, 0, 0}, {1.5, 0.1, 0}, {0, 0.1, 0}}));
  add("triangle", mesh_scene({{0, 0, 0}, {1, 0.2, 0}, {0.3, 1, 0}}, {{0, 1, 2}}));
  add("sheared", polygon_scene({{0, 0, 0}, {1, 0, 0}, {1.5, 1, 0}, {0.5, 1, 0}}));
  add("hexagon",
      polygon_scene(
          {{0, 0.4, 0}, {0.3, 0, 0}, {0.9, 0.1, 0}, {1.1, 0.6, 0}, {0.8, 1, 0}, {0.2, 0.9, 0}}));
  add("disk", disk_scene(0.7));
  return all;
}

}  // namespace troffer::test
