// Flat shapes divided into triangles in many ways, anywhere in space.
#pragma once

#include <functional>
#include <utility>
#include <vector>

#include "base/frame.h"
#include "base/random.h"
#include "base/warp.h"
#include "scene/scene.h"

namespace troffer::test {

// Triangles in the plane, with exact coordinates; counterclockwise.
struct Tessellation {
  std::vector<Vec2d> points;
  std::vector<Triangle> triangles;
};

// Returns the rectangle [0,width] × [0,height] as n × m rectangles of random sizes, each split
// along a random diagonal. Rectangles for which is_hole(column, row) holds are left out.
inline Tessellation random_grid(
    Random& r, uint32_t n, uint32_t m, double width, double height,
    const std::function<bool(uint32_t, uint32_t)>& is_hole = [](uint32_t, uint32_t) {
      return false;
    }) {
  const auto places = [&](uint32_t count, double size) {
    std::vector<double> at{0};
    for (uint32_t i = 0; i < count; ++i) at.push_back(at.back() + 0.2 + r.next_double());
    const double scale = size / at.back();
    for (double& a : at) a *= scale;
    return at;
  };
  const std::vector<double> x = places(n, width), y = places(m, height);
  Tessellation t;
  for (uint32_t j = 0; j <= m; ++j)
    for (uint32_t i = 0; i <= n; ++i) t.points.push_back({x[i], y[j]});
  for (uint32_t j = 0; j < m; ++j)
    for (uint32_t i = 0; i < n; ++i) {
      if (is_hole(i, j)) continue;
      const uint32_t a = j * (n + 1) + i, b = a + 1, c = b + n + 1, d = a + n + 1;
      if (r.next_u32() % 2 == 0) {
        t.triangles.push_back({a, b, c});
        t.triangles.push_back({a, c, d});
      } else {
        t.triangles.push_back({b, c, d});
        t.triangles.push_back({b, d, a});
      }
    }
  return t;
}

// Returns a convex polygon that is split at random points inside triangles and on edges. least:
// least distance of a point from an edge's end, as a share of the edge.
inline Tessellation random_splits(Random& r, std::vector<Vec2d> corners, int splits, double least) {
  Tessellation t;
  t.points = std::move(corners);
  for (uint32_t i = 1; i + 1 < t.points.size(); ++i) t.triangles.push_back({0, i, i + 1});
  for (int s = 0; s < splits; ++s) {
    const size_t at = r.next_u32() % t.triangles.size();
    const Triangle old = t.triangles[at];
    const auto fresh = uint32_t(t.points.size());
    const double u = least + (1 - 2 * least) * r.next_double();
    if (r.next_u32() % 3 == 0) {
      const Vec2d middle =
          t.points[old[0]] * (u / 2) + t.points[old[1]] * (0.5 - u / 2) + t.points[old[2]] * 0.5;
      t.points.push_back(middle);
      t.triangles[at] = {old[0], old[1], fresh};
      t.triangles.push_back({old[1], old[2], fresh});
      t.triangles.push_back({old[2], old[0], fresh});
      continue;
    }
    const size_t side = r.next_u32() % 3;
    const uint32_t from = old[side], to = old[(side + 1) % 3];
    t.points.push_back(t.points[from] * (1 - u) + t.points[to] * u);
    for (size_t i = t.triangles.size(); i-- > 0;)
      for (size_t k = 0; k < 3; ++k) {
        const uint32_t p = t.triangles[i][k], q = t.triangles[i][(k + 1) % 3];
        if (!((p == from && q == to) || (p == to && q == from))) continue;
        const uint32_t apex = t.triangles[i][(k + 2) % 3];
        t.triangles[i] = {p, fresh, apex};
        t.triangles.push_back({fresh, q, apex});
        break;
      }
  }
  return t;
}

// A rigid motion. `distance`: largest distance of the origin.
struct Place {
  Framed frame{Vec3d{0, 0, 1}};
  Vec3d origin;
  Vec3 at(const Vec2d& p, double height = 0) const {
    return Vec3(origin + frame.tangent * p.x + frame.bitangent * p.y + frame.normal * height);
  }
};
inline Place random_place(Random& r, double distance) {
  Place p;
  p.frame = Framed(Vec3d(sphere_from_square(r.next_vec2())));
  const double angle = 6.2 * r.next_double();
  const Vec3d t = p.frame.tangent, b = p.frame.bitangent;
  p.frame.tangent = t * std::cos(angle) + b * std::sin(angle);
  p.frame.bitangent = b * std::cos(angle) - t * std::sin(angle);
  p.frame.tangent = normalize(p.frame.tangent);
  p.frame.bitangent = normalize(cross(p.frame.normal, p.frame.tangent));
  p.origin =
      Vec3d{r.next_double() - 0.5, r.next_double() - 0.5, r.next_double() - 0.5} * (2 * distance);
  return p;
}

inline void append(Mesh& m, const Tessellation& t, const Place& place, double height = 0) {
  const auto base = uint32_t(m.positions.size());
  for (const Vec2d& p : t.points) m.positions.push_back(place.at(p, height));
  for (const Triangle& c : t.triangles)
    m.triangles.push_back({c[0] + base, c[1] + base, c[2] + base});
}

}  // namespace troffer::test
