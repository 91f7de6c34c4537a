// Occluders of a source in (u,v) with exact areas, for tests of the bintree.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include "base/vec.h"
#include "kj92/bintree.h"

namespace troffer {

// A convex polygon in (u,v), counterclockwise. It hides its inside.
struct ConvexOccluder {
  std::vector<Vec2d> vertices;

  bool hides(const Vec2& p) const {
    const Vec2d q(p);
    for (size_t i = 0; i < vertices.size(); ++i) {
      const Vec2d &a = vertices[i], b = vertices[(i + 1) % vertices.size()] - a, c = q - a;
      if (b.x * c.y - b.y * c.x < 0) return false;
    }
    return true;
  }
  // Returns the area of the part inside the unit square, clipped exactly.
  double area() const {
    std::vector<Vec2d> p = vertices;
    for (size_t side = 0; side < 4; ++side) {
      std::vector<Vec2d> q;
      const auto inside = [&](const Vec2d& x) {
        return side % 2 == 0 ? x[side / 2] : 1 - x[side / 2];
      };
      for (size_t i = 0; i < p.size(); ++i) {
        const Vec2d a = p[i], b = p[(i + 1) % p.size()];
        const double da = inside(a), db = inside(b);
        if (da >= 0) q.push_back(a);
        if (da * db < 0) q.push_back(a + (b - a) * (da / (da - db)));
      }
      p = q;
    }
    double twice = 0;
    for (size_t i = 0; i < p.size(); ++i) {
      const Vec2d a = p[i], b = p[(i + 1) % p.size()];
      twice += a.x * b.y - a.y * b.x;
    }
    return twice / 2;
  }
};

// Returns a rectangle around `centre`, rotated by `angle`.
inline ConvexOccluder turned_rectangle(const Vec2d& centre, double width, double height,
                                       double angle) {
  const Vec2d x{std::cos(angle) * width / 2, std::sin(angle) * width / 2};
  const Vec2d y{-std::sin(angle) * height / 2, std::cos(angle) * height / 2};
  return {{centre - x - y, centre + x - y, centre + x + y, centre - x + y}};
}
// Returns the half-plane to the left of the line through p with direction (cos, sin) of angle.
inline ConvexOccluder half_plane(const Vec2d& p, double angle) {
  const Vec2d left{-std::sin(angle), std::cos(angle)};
  return turned_rectangle(p + left * 10.0, 20, 20, angle);
}
// Returns a regular polygon of 256 corners: a disk to 1e-4 of its area.
inline ConvexOccluder disk_occluder(const Vec2d& centre, double radius) {
  ConvexOccluder o;
  for (int i = 0; i < 256; ++i) {
    const double a = 2 * pi * i / 256;
    o.vertices.push_back(centre + Vec2d{std::cos(a), std::sin(a)} * radius);
  }
  return o;
}

// Turns a predicate hides(uv) into a query for a bintree, with kernel 1.
template <class Hides>
auto query_of(Hides hides) {
  return [hides](std::span<const Vec2> uv, std::span<ShadowRayResult> results) {
    for (size_t i = 0; i < uv.size(); ++i) results[i] = {!hides(uv[i]), 1.0f};
  };
}
inline auto query_of(const ConvexOccluder& o) {
  return query_of([&o](const Vec2& p) { return o.hides(p); });
}

}  // namespace troffer
