#include "report/floor_outline.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

#include "base/random.h"
#include "base/units.h"
#include "report/above.h"

namespace troffer {

std::vector<Vec3d> places_on(const std::vector<const FlatFace*>& faces, size_t count) {
  std::vector<double> sums;
  std::vector<const std::array<Vec3d, 3>*> all;
  double sum = 0;
  for (const FlatFace* f : faces)
    for (const auto& t : f->triangles) {
      sum += length(cross(t[1] - t[0], t[2] - t[0]));
      sums.push_back(sum);
      all.push_back(&t);
    }
  Random random(1);
  std::vector<Vec3d> places;
  for (size_t i = 0; i < count; ++i) {
    const double at = sum * (double(i) + random.next_double()) / double(count);
    const size_t k = std::min(size_t(std::lower_bound(sums.begin(), sums.end(), at) - sums.begin()),
                              sums.size() - 1);
    double a = random.next_double(), b = random.next_double();
    if (a + b > 1) {
      a = 1 - a;
      b = 1 - b;
    }
    const auto& t = *all[k];
    places.push_back(t[0] + (t[1] - t[0]) * a + (t[2] - t[0]) * b);
  }
  return places;
}

// Opposite edges cancel in pairs. Coincident faces count separately, so their outlines remain.
std::vector<PlaneSegment> outline_of(const std::vector<const FlatFace*>& faces,
                                     const FloorPlane& plane) {
  using Key = std::array<int64_t, 2>;
  const auto key = [](const Vec2d& p) {
    return Key{std::llround(p.x * 1e4), std::llround(p.y * 1e4)};
  };
  std::map<std::pair<Key, Key>, std::pair<int, PlaneSegment>> edges;
  for (const FlatFace* f : faces)
    for (const auto& t : f->triangles)
      for (size_t k = 0; k < 3; ++k) {
        const Vec2d a = plane.flat(t[k]), b = plane.flat(t[(k + 1) % 3]);
        const bool is_forward = key(a) < key(b);
        auto& e = edges[is_forward ? std::pair{key(a), key(b)} : std::pair{key(b), key(a)}];
        e.first += is_forward ? 1 : -1;
        e.second = is_forward ? PlaneSegment{a, b} : PlaneSegment{b, a};
      }
  std::vector<PlaneSegment> outline;
  for (const auto& [k, e] : edges)
    for (int i = 0; i < std::abs(e.first); ++i)
      outline.push_back(e.first > 0 ? e.second : PlaneSegment{e.second.b, e.second.a});
  return outline;
}

bool is_within(const PlaneCell& c, const Vec2d& p) {
  for (size_t k = 0; k < 4; ++k) {
    const Vec2d way = c.corners[(k + 1) % 4] - c.corners[k], to = p - c.corners[k];
    if (way.x * to.y - way.y * to.x < 0) return false;
  }
  return true;
}

namespace {

// Returns random places, spread over the cells by area.
std::vector<Vec3d> places_in(const FloorPlane& plane, const std::vector<const PlaneCell*>& cells,
                             size_t count) {
  double sum = 0, whole = 0;
  for (const PlaneCell* c : cells) whole += c->area;
  Random random(1);
  std::vector<Vec3d> places;
  for (const PlaneCell* cell : cells) {
    sum += cell->area;
    const auto& c = cell->corners;
    while (places.size() < count && double(places.size()) + 0.5 < double(count) * sum / whole) {
      const double s = random.next_double(), t = random.next_double();
      const Vec2d low = c[0] + (c[1] - c[0]) * s, high = c[3] + (c[2] - c[3]) * s;
      places.push_back(plane.place(low + (high - low) * t) + plane.up * rug);
    }
  }
  return places;
}

}  // namespace

FloorSurroundings look_around(const PreparedScene& scene, const FloorPlane& plane,
                              const std::vector<const PlaneCell*>& cells) {
  constexpr size_t count = 96;
  constexpr int directions = 8;
  constexpr double eye = 1.2;  // m
  FloorSurroundings s;
  const std::vector<Vec3d> places = places_in(plane, cells, count);
  if (places.empty()) return s;
  for (const Above& a : above(scene, places, plane.up)) {
    const bool is_clear = a.height >= headroom - rug && !a.is_within;
    s.clear += is_clear ? 1 : 0;
    s.roofed += is_clear && std::isfinite(a.height) ? 1 : 0;
  }
  std::vector<Ray> rays;
  for (const Vec3d& p : places)
    for (int k = 0; k < directions; ++k) {
      const double a = 2 * pi * (k + 0.3) / directions;
      rays.push_back(ray_from(scene, p + plane.up * eye,
                              plane.along * std::cos(a) + plane.across * std::sin(a)));
    }
  std::vector<Hit> hits(rays.size());
  scene.tracer.closest(rays, hits);
  for (const Hit& h : hits) s.enclosed += h.is_valid() ? 1 : 0;
  s.clear /= double(places.size());
  s.roofed /= double(places.size());
  s.enclosed /= double(rays.size());
  return s;
}

}  // namespace troffer
