// Random scenes with sources of every kind, and random receivers.
#pragma once

#include <cmath>
#include <vector>

#include "base/frame.h"
#include "base/random.h"
#include "base/warp.h"
#include "light/light_primitive.h"
#include "scene/scene.h"
#include "support/scenes.h"

namespace troffer::test {

inline Vec3 random_point(Random& r, float scale) {
  const float x = r.next_float(), y = r.next_float();
  return (Vec3{x, y, r.next_float()} - Vec3{0.5f}) * (2 * scale);
}
inline Vec3 random_direction(Random& r) {
  return sphere_from_square(r.next_vec2());
}
// Returns a log-uniform random size.
inline float random_size(Random& r, float smallest, float largest) {
  return smallest * std::pow(largest / smallest, r.next_float());
}

inline void add_mesh_light(Scene& s, uint32_t material, std::vector<Vec3> positions,
                           std::vector<Triangle> triangles, Rgb radiance, bool is_two_sided) {
  Mesh m;
  m.positions = std::move(positions);
  m.triangles = std::move(triangles);
  m.material = material;
  m.lights.assign(m.triangles.size(), int32_t(s.lights.size()));
  Light e;
  e.name = "emitter" + std::to_string(s.lights.size());
  e.kind = LightKind::mesh;
  e.radiance = radiance;
  e.is_two_sided = is_two_sided;
  e.geometry = uint32_t(s.meshes.size());
  for (uint32_t t = 0; t < m.triangles.size(); ++t) e.triangles.push_back(t);
  s.meshes.push_back(std::move(m));
  s.lights.push_back(std::move(e));
}

inline void add_sphere_light(Scene& s, uint32_t material, const Vec3& centre, float radius,
                             Rgb radiance, bool is_two_sided = false, bool is_inside_out = false) {
  Light e;
  e.name = "emitter" + std::to_string(s.lights.size());
  e.kind = LightKind::sphere;
  e.radiance = radiance;
  e.is_two_sided = is_two_sided;
  e.geometry = uint32_t(s.spheres.size());
  s.spheres.push_back({centre, radius, is_inside_out, material, int32_t(s.lights.size())});
  s.lights.push_back(std::move(e));
}

inline void add_disk_light(Scene& s, uint32_t material, const Vec3& centre, const Vec3& normal,
                           float radius, Rgb radiance, bool is_two_sided = false) {
  Light e;
  e.name = "emitter" + std::to_string(s.lights.size());
  e.kind = LightKind::disk;
  e.radiance = radiance;
  e.is_two_sided = is_two_sided;
  e.geometry = uint32_t(s.disks.size());
  s.disks.push_back({centre, normal, radius, material, int32_t(s.lights.size())});
  s.lights.push_back(std::move(e));
}

// Adds one source of random kind, position, size and radiance.
inline void add_random_source(Scene& s, Random& r, float place, float largest) {
  const Vec3 at = random_point(r, place);
  const Vec3 n = random_direction(r);
  const float size = random_size(r, 1e-3f, largest);
  const Rgb radiance{random_size(r, 1e-3f, 1e3f)};
  const bool is_two_sided = r.next_u32() % 3 == 0;
  const Frame f(n);
  const Vec3 x = f.tangent * size, y = f.bitangent * (size * random_size(r, 0.05f, 1));
  switch (r.next_u32() % 5) {
    case 0:
      make_light(s, add_quad(s, 0, {at - x - y, at + x - y, at + x + y, at - x + y}), radiance,
                 is_two_sided);
      break;
    case 1:
      add_mesh_light(s, 0, {at, at + x, at + y}, {{0, 1, 2}}, radiance, is_two_sided);
      break;
    case 2:
      add_sphere_light(s, 0, at, size, radiance, is_two_sided, r.next_u32() % 4 == 0);
      break;
    case 3:
      add_disk_light(s, 0, at, n, size, radiance, is_two_sided);
      break;
    default:  // a folded strip of triangles
      add_mesh_light(s, 0, {at, at + x, at + y, at + x + n * size, at + x + y + n * size},
                     {{0, 1, 2}, {1, 3, 2}, {3, 4, 2}}, radiance, is_two_sided);
  }
}

inline Scene random_lights(uint64_t seed, int sources) {
  Random r(seed);
  Scene s;
  add_diffuse(s, Rgb{0.5f});
  const float place = random_size(r, 0.3f, 30), largest = random_size(r, 0.1f, 5);
  for (int i = 0; i < sources; ++i) add_random_source(s, r, place, largest);
  return s;
}

struct Receiver {
  Vec3 position, normal;
};

// Returns a receiver at random: anywhere, far away, within a source's bounds, in its plane, or on
// it.
inline Receiver random_receiver(const LightPrimitives& lights, Random& r) {
  Receiver out{random_point(r, 10), random_direction(r)};
  const LightPrimitive& p = lights[r.next_u32() % lights.size()];
  const Vec3 e = p.bounds.extent();
  const Vec3 inside = p.bounds.lower + e * Vec3{r.next_float(), r.next_float(), r.next_float()};
  switch (r.next_u32() % 6) {
    case 0:
      out.position = random_point(r, 1000);
      break;
    case 1:
      out.position = inside;
      break;
    case 2:  // near the source's plane
      out.position = p.vertex_count > 2
                         ? p.vertex(0) + (p.vertex(1) - p.vertex(0)) * (5 * r.next_float()) +
                               (p.vertex(2) - p.vertex(0)) * (5 * r.next_float() - 2)
                         : inside;
      break;
    case 3:  // in front of the source, close to it, on a parallel surface
      out.position = p.centroid + Vec3(p.normal) * (p.radius * random_size(r, 1e-4f, 1));
      if (p.vertex_count > 0) out.normal = -Vec3(p.normal);
      break;
    case 4:
      out.position = p.centroid;
      break;
    default:
      break;
  }
  return out;
}

}  // namespace troffer::test
