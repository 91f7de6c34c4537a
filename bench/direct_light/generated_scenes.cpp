#include "generated_scenes.h"

#include <cmath>
#include <utility>

#include "base/random.h"
#include "base/warp.h"
#include "render/camera.h"

namespace troffer::bench {

void add_box(Mesh& m, const Vec3& lower, const Vec3& upper, float angle, bool is_inward) {
  const auto base = uint32_t(m.positions.size());
  const Vec3 c = (lower + upper) * 0.5f;
  for (int i = 0; i < 8; ++i) {
    const Vec3 p{(i & 1) != 0 ? upper.x : lower.x, (i & 2) != 0 ? upper.y : lower.y,
                 (i & 4) != 0 ? upper.z : lower.z};
    const Vec3 d = p - c;
    m.positions.push_back({c.x + d.x * std::cos(angle) - d.y * std::sin(angle),
                           c.y + d.x * std::sin(angle) + d.y * std::cos(angle), p.z});
  }
  constexpr uint32_t quads[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                    {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
  for (const auto& q : quads) {
    Triangle a{base + q[0], base + q[1], base + q[2]}, d{base + q[0], base + q[2], base + q[3]};
    if (is_inward) {
      std::swap(a[1], a[2]);
      std::swap(d[1], d[2]);
    }
    m.triangles.push_back(a);
    m.triangles.push_back(d);
  }
}

void add_ball(Mesh& m, const Vec3& c, float radius) {
  constexpr uint32_t n = 16, rings = 9;
  const auto base = uint32_t(m.positions.size());
  for (uint32_t r = 0; r <= rings; ++r)
    for (uint32_t i = 0; i < n; ++i) {
      const float theta = pi_f * float(r) / float(rings), phi = 2 * pi_f * float(i) / float(n);
      const float ring = r == 0 || r == rings ? 0 : std::sin(theta);
      m.positions.push_back(c + Vec3{ring * std::cos(phi), ring * std::sin(phi), std::cos(theta)} *
                                    radius);
    }
  for (uint32_t r = 0; r < rings; ++r)
    for (uint32_t i = 0; i < n; ++i) {
      const uint32_t a = base + r * n + i, b = base + r * n + (i + 1) % n;
      if (r > 0) m.triangles.push_back({a, a + n, b});
      if (r + 1 < rings) m.triangles.push_back({b, a + n, b + n});
    }
}

void add_sheet(Mesh& m, const Vec3& corner, const Vec3& u, const Vec3& v) {
  const auto base = uint32_t(m.positions.size());
  for (const Vec3& p : {corner, corner + u, corner + u + v, corner + v}) m.positions.push_back(p);
  m.triangles.push_back({base, base + 1, base + 2});
  m.triangles.push_back({base, base + 2, base + 3});
}

void add_light(Scene& s, const Vec3& corner, const Vec3& u, const Vec3& v) {
  Mesh m;
  add_sheet(m, corner, u, v);
  m.lights = {int32_t(s.lights.size()), int32_t(s.lights.size())};
  Light e;
  e.radiance = Rgb{1};
  e.geometry = uint32_t(s.meshes.size());
  e.triangles = {0, 1};
  e.polygon = m.positions;
  s.lights.push_back(e);
  s.meshes.push_back(m);
}

void add_square_light(Scene& s, const Vec3& centre, float size) {
  const float h = size / 2;
  add_light(s, centre + Vec3{-h, -h, 0}, {0, size, 0}, {size, 0, 0});
}

Scene clutter() {
  Scene s;
  s.materials.resize(1);
  Mesh room, things;
  add_box(room, {-3, -3, 0}, {3, 3, 3}, 0, true);
  add_box(things, {-1, -0.6f, 0.7f}, {1, 0.6f, 0.74f}, 0, false);
  for (int i = 0; i < 4; ++i) {
    const float x = (i & 1) != 0 ? 0.9f : -0.9f, y = (i & 2) != 0 ? 0.5f : -0.5f;
    add_box(things, {x - 0.03f, y - 0.03f, 0}, {x + 0.03f, y + 0.03f, 0.7f}, 0, false);
  }
  Random random(3);
  for (int i = 0; i < 120; ++i) {
    const float r = 0.02f + 0.04f * random.next_float();
    const float x = 1.9f * random.next_float() - 0.95f, y = 1.1f * random.next_float() - 0.55f;
    add_ball(things, {x, y, 0.742f + r + 0.2f * random.next_float()}, r);
  }
  for (int i = 0; i < 120; ++i) {
    const float x = 1.9f * random.next_float() - 0.95f, y = 1.1f * random.next_float() - 0.55f;
    const float hx = 0.01f + 0.04f * random.next_float(), hy = 0.01f + 0.04f * random.next_float();
    const float height = 0.02f + 0.2f * random.next_float();
    add_box(things, {x - hx, y - hy, 0.742f}, {x + hx, y + hy, 0.742f + height},
            3 * random.next_float(), false);
  }
  s.meshes = {room, things};
  add_square_light(s, {-1.2f, 0, 2.9f}, 1);
  add_square_light(s, {1.2f, 0.5f, 2.9f}, 1);
  s.cameras = {look_at({0.3f, -2.6f, 1.9f}, {0, 0, 0.6f}, {0, 0, 1}, 50)};
  return s;
}

Scene foliage() {
  Scene s;
  s.materials.resize(1);
  Mesh ground, leaves;
  add_box(ground, {-4, -4, -0.1f}, {4, 4, 0}, 0, false);
  Random random(4);
  for (int crown = 0; crown < 5; ++crown) {
    const Vec3 centre{-2 + float(crown), 0.4f * float(crown % 2), 1.2f};
    for (int i = 0; i < 20000; ++i) {
      const Vec3 p =
          centre + sphere_from_square(random.next_vec2()) * (0.6f * std::cbrt(random.next_float()));
      const Vec3 along = sphere_from_square(random.next_vec2());
      const Vec3 across = normalize(cross(along, sphere_from_square(random.next_vec2())));
      const auto base = uint32_t(leaves.positions.size());
      leaves.positions.push_back(p);
      leaves.positions.push_back(p + along * 0.015f + across * 0.006f);
      leaves.positions.push_back(p + along * 0.03f);
      leaves.positions.push_back(p + along * 0.015f - across * 0.006f);
      leaves.triangles.push_back({base, base + 1, base + 2});
      leaves.triangles.push_back({base, base + 2, base + 3});
    }
  }
  s.meshes = {ground, leaves};
  add_square_light(s, {0, 0, 4}, 2);
  s.cameras = {look_at({0, -4.5f, 2.2f}, {0, 0, 0.5f}, {0, 0, 1}, 45)};
  return s;
}

}  // namespace troffer::bench
