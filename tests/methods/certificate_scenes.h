// Random scenes for certificates: sources of every shape, clusters of real extent, and occluders
// between them, of any size and far from the origin.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/frame.h"
#include "base/random.h"
#include "base/units.h"
#include "shadow/shadow_cluster.h"
#include "support/scenes.h"
#include "trace/occluders.h"

namespace troffer::test {

enum class SourceShape : uint8_t {
  parallelogram,
  triangle,
  polygon,
  disk,
  sphere,
  far_square,
  far_disk
};
constexpr int source_shapes = 7;

// Place and size of a scene. Coordinates are rounded only once, at the end.
struct Placing {
  double scale = 1;
  Vec3d offset;
  Vec3 operator()(const Vec3d& p) const { return Vec3(p * scale + offset); }
};

struct CertificateScene {
  Scene scene;
  SourceShape shape = SourceShape::parallelogram;
  FlatSource flat;
  SphereSource sphere;
  std::vector<ShadowReceiver> receivers;
  bool is_far() const { return shape >= SourceShape::far_square; }
};

inline Vec3d random_in_cube(Random& r) {
  const double x = r.next_double(), y = r.next_double();
  return Vec3d{x, y, r.next_double()} * 2.0 - Vec3d(1.0);
}
inline double log_uniform(Random& r, double from, double to) {
  return from * std::pow(to / from, r.next_double());
}

inline void add_facet(Scene& s, const Placing& at, const Vec3d& corner, const Vec3d& u,
                      const Vec3d& v) {
  add_quad(s, 0, {at(corner), at(corner + u), at(corner + u + v), at(corner + v)});
}

// Adds a cell at infinity as in sky_patches.h, or a sun, somewhere above.
inline void add_far_source(Random& r, const Placing& at, CertificateScene& out) {
  const double distance = 0x1p20 * 4 * at.scale;
  const Framed frame(-normalize(Vec3d{0, 0, 1.1} + random_in_cube(r)));
  out.flat.is_disk = out.shape == SourceShape::far_disk;
  const double size =
      distance * (out.flat.is_disk ? log_uniform(r, 0.009, 0.1) : log_uniform(r, 0.01, 2));
  const Vec3d u = frame.tangent * size, v = frame.bitangent * size;
  out.flat.plane = {at.offset - frame.normal * distance - (u + v) * 0.5, u, v, frame.normal};
}

// Adds a source around (0,0,2), which roughly faces down.
inline void add_source(Random& r, const Placing& at, CertificateScene& out) {
  const Vec3d centre{0, 0, 2};
  const double size = log_uniform(r, 0.02, 4);
  out.shape = SourceShape(int(r.next_double() * source_shapes));
  if (out.shape == SourceShape::sphere) {
    const Sphere ball{at(centre), float(std::min(0.25 * size, 0.9) * at.scale)};
    out.scene.spheres.push_back(ball);
    out.sphere = {Vec3d(ball.centre), double(ball.radius),
                  Occluders::key(uint32_t(out.scene.meshes.size()), 0)};
    return;  // the key is set again when all meshes are known
  }
  if (out.is_far()) return add_far_source(r, at, out);
  const Framed frame(normalize(Vec3d{0, 0, -1} + random_in_cube(r) * (r.next_double() * 0.6)));
  if (out.shape == SourceShape::disk) {
    const double radius = 0.5 * size * at.scale;
    const Vec3d u = frame.tangent * (2 * radius), v = frame.bitangent * (2 * radius);
    out.flat.plane = {Vec3d(at(centre)) - (u + v) * 0.5, u, v, frame.normal};
    out.flat.is_disk = true;
    return;
  }
  const double width = size * log_uniform(r, 0.01, 1);
  std::vector<Vec3> corners;
  if (out.shape == SourceShape::parallelogram) {
    const Vec3d u = frame.tangent * size;
    const Vec3d v = frame.bitangent * width + frame.tangent * (width * (r.next_double() - 0.5));
    const Vec3d c = centre - (u + v) * 0.5;
    corners = {at(c), at(c + u), at(c + u + v), at(c + v)};
  } else {
    const int n = out.shape == SourceShape::triangle ? 3 : 5 + int(r.next_double() * 3);
    for (int i = 0; i < n; ++i) {
      const double a = 2 * pi * (i + 0.5 * r.next_double()) / n;
      corners.push_back(at(centre + frame.tangent * (0.5 * size * std::cos(a)) +
                           frame.bitangent * (0.5 * width * std::sin(a))));
    }
  }
  if (!make_flat_source(corners, out.flat)) return;
  if (out.shape == SourceShape::parallelogram)
    add_quad(out.scene, 0, {corners[0], corners[1], corners[2], corners[3]});
}

// Adds a cluster around (0,0,0): a thumbnail's tile of some metres, a strip seen at a grazing
// angle, a few millimetres, or a curved surface.
inline void add_receivers(Random& r, const Placing& at, CertificateScene& out) {
  const double size = log_uniform(r, 1e-3, 6);
  const double width = r.next_double() < 0.5 ? size : size * log_uniform(r, 1e-3, 1);
  const Vec3d normal =
      r.next_double() < 0.5 ? Vec3d{0, 0, 1} : normalize(Vec3d{0, 0, 1} + random_in_cube(r) * 0.8);
  const Framed frame(normal);
  const double turn = 2 * pi * r.next_double();
  const Vec3d along = frame.tangent * std::cos(turn) + frame.bitangent * std::sin(turn);
  const Vec3d across = cross(normal, along);
  const double curvature = r.next_double() < 0.3 ? 0.3 / size : 0;
  const bool is_bumpy = r.next_double() < 0.15;
  for (int i = 0; i < 64; ++i) {
    const double a = size * (((i % 8) + r.next_double()) / 8 - 0.5);
    const double b = width * (((i / 8) + r.next_double()) / 8 - 0.5);
    ShadowReceiver x;
    x.position = at(along * a + across * b - normal * (0.5 * curvature * (a * a + b * b)));
    x.horizon = Vec3(normalize(normal + (along * a + across * b) * curvature));
    x.normal = is_bumpy ? normalize(x.horizon + Vec3(random_in_cube(r)) * 0.2f) : x.horizon;
    const float reach =
        std::max({std::abs(x.position.x), std::abs(x.position.y), std::abs(x.position.z)});
    x.origin = x.position + x.horizon * (4e-6f * reach);
    x.stream = r.next_u64();
    out.receivers.push_back(x);
  }
}

// Adds a closed box with its front outside.
inline void add_closed_box(Random& r, const Placing& at, Scene& s) {
  const Vec3d centre = random_in_cube(r) * 0.8 + Vec3d{0, 0, 1};
  const Vec3d x = random_in_cube(r) * 0.3;
  const Vec3d y = normalize(cross(x, random_in_cube(r))) * log_uniform(r, 0.01, 0.6);
  const Vec3d z = normalize(cross(x, y)) * log_uniform(r, 0.01, 0.6);
  Mesh m;
  for (uint32_t i = 0; i < 8; ++i)
    m.positions.push_back(at(centre + x * (i & 1u ? 1.0 : -1.0) + y * (i & 2u ? 0.5 : -0.5) +
                             z * (i & 4u ? 0.5 : -0.5)));
  m.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                 {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  s.meshes.push_back(std::move(m));
}

// Adds plates, wires, specks, canopies around the source, walls, things that stand on the receivers
// or cross the source, closed boxes, combs, and sometimes things that are no facets.
inline void add_occluders(Random& r, const Placing& at, CertificateScene& out) {
  Scene& s = out.scene;
  const int n = int(r.next_double() * 7);
  for (int i = 0; i < n; ++i) {
    Vec3d corner = random_in_cube(r) + Vec3d{0, 0, 1}, u = random_in_cube(r), v = random_in_cube(r);
    const int kind = int(r.next_double() * 10);
    if (kind == 0) {  // wire
      v = normalize(v) * 1e-3;
      u = u * 3.0;
    } else if (kind == 1) {  // speck
      u = u * 0.01;
      v = v * 0.01;
    } else if (kind == 2) {  // level, close to the source or to the receivers
      const double z =
          r.next_double() < 0.7 ? 2 + 0.2 * (r.next_double() - 0.7) : log_uniform(r, 1e-3, 0.1);
      const double half = log_uniform(r, 0.1, 3);
      corner = {-half, -half, z};
      u = {2 * half, 0, 0};
      v = {0, 2 * half, 0};
    } else if (kind == 3) {  // a wall through everything
      corner = {random_in_cube(r).x * 0.5, -5, -1};
      u = {0, 10, 0};
      v = {random_in_cube(r).x * 0.2, 0, 5};
    } else if (kind == 4) {  // stands on the plane of receivers
      corner = Vec3d{corner.x, corner.y, 0} * 0.3;
      u.z = 0;
      v = {0, 0, 0.5};
    } else if (kind <= 6) {  // hides most of the source
      const double half = log_uniform(r, 0.5, 6);
      corner = {-half, -half, 0.2 + 1.7 * r.next_double()};
      u = {2 * half, 0, 0};
      v = {0, 2 * half, 0};
    } else if (kind == 7) {
      add_closed_box(r, at, s);
      continue;
    }
    add_facet(s, at, corner, u, v);
  }
  if (r.next_double() < 0.05)
    for (int i = 0; i < 64; ++i)
      add_facet(s, at, {-1 + i / 32.0, -1, 1.2}, {1.0 / 64, 0, 0}, {0, 2, 0});
  if (r.next_double() < 0.5) return;
  const int rounds = int(r.next_double() * 4);
  for (int i = 0; i < rounds; ++i) {
    const Vec3 centre = at(random_in_cube(r) + Vec3d{0, 0, 1.1});
    const auto radius = float(log_uniform(r, 0.002, 1.5) * at.scale);
    const bool is_disk = r.next_double() < 0.5;
    if (is_disk)
      s.disks.push_back({centre, Vec3(normalize(random_in_cube(r))), radius, 0, no_light});
    else
      s.spheres.push_back({centre, radius});
  }
}

// Adds a plate around a sphere or beside it, at about the height of its centre. Some receivers see
// past it, others do not.
inline void add_collar(Random& r, const Placing& at, const SphereSource& sphere, Scene& s) {
  const double radius = sphere.radius / at.scale, half = radius * log_uniform(r, 1.05, 6);
  const double inner = r.next_double() < 0.7 ? -half : radius * (1 + r.next_double());
  const double tilt = r.next_double() < 0.5 ? 0 : 0.1 * half;
  const Vec3d corner{inner, -half, 2 + 0.3 * radius * (r.next_double() - 0.2)};
  add_facet(s, at, corner, {half - inner, 0, tilt * (r.next_double() - 0.5)},
            {0, 2 * half, tilt * (r.next_double() - 0.5)});
}

inline CertificateScene random_certificate_scene(uint64_t seed) {
  Random r(seed);
  CertificateScene out;
  out.scene.materials.emplace_back();
  Placing at;
  const double scales[] = {1, 50, 1e-3}, offsets[] = {0, 1000, 5000};
  at.scale = scales[int(r.next_double() * 3)];
  const double offset = offsets[int(r.next_double() * 3)];
  at.offset = {offset, r.next_double() < 0.5 ? offset : -0.6 * offset, 0};
  add_source(r, at, out);
  add_occluders(r, at, out);
  add_receivers(r, at, out);
  if (out.shape == SourceShape::sphere && r.next_double() < 0.5)
    add_collar(r, at, out.sphere, out.scene);
  if (out.shape == SourceShape::sphere)
    out.sphere.own = Occluders::key(uint32_t(out.scene.meshes.size()), 0);
  return out;
}

}  // namespace troffer::test
