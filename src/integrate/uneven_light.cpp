#include "integrate/uneven_light.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "base/units.h"
#include "light/irradiance.h"

namespace troffer {

namespace {

constexpr float reach = 3;            // how far away lights are looked for, in widths of the cell
constexpr double most_spread = 0.5;   // of irradiance over a cell: standard deviation over mean
constexpr size_t most_lights = 1024;  // more pieces are not looked at: smaller cells have fewer
constexpr int per_side = 3;           // places along either side of a cell
constexpr size_t places = size_t(per_side) * per_side;

float distance_squared(const Box& b, const Vec3& x) {
  return length_squared(max(max(b.lower - x, x - b.upper), Vec3(0)));
}

// Luminance of what a piece of a light sends to x, as if nothing stood between them.
double arriving(const LightPrimitive& p, const Vec3d& x, const Vec3d& n) {
  if (p.shape != PrimitiveShape::point)
    return irradiance(p, x, n) * double(luminance(p.mean_radiance));
  const Vec3d d = Vec3d(p.centroid) - x;
  const double d2 = length_squared(d);
  return d2 > 0 ? double(p.tree_power) / (4 * pi) * std::max(dot(d, n), 0.0) / (d2 * std::sqrt(d2))
                : 0;
}

// Where it is nearest to x: of polygons by their bounds, and in their plane.
Vec3 nearest_point(const LightPrimitive& p, const Vec3& x) {
  if (p.vertex_count == 0) return p.centroid;
  const Vec3 inside = max(min(x, p.bounds.upper), p.bounds.lower), n(p.normal);
  const Vec3 in_plane = inside - n * dot(inside - p.centroid, n);
  return max(min(in_plane, p.bounds.upper), p.bounds.lower);
}

// What arrives at the places of a cell.
struct Arriving {
  std::array<double, places> all{}, strongest{};
  std::array<Ray, places> towards;  // the strongest
};

Arriving arriving_at(const PreparedScene& scene, const std::vector<uint32_t>& lights,
                     const CellOutline& cell) {
  Arriving a;
  const Vec3 &corner = cell.corners[0], u = cell.corners[1] - corner, v = cell.corners[3] - corner;
  const Vec3d normal(cell.normal);
  for (size_t i = 0; i < places; ++i) {
    const float s = (float(i % per_side) + 0.5f) / per_side,
                t = (float(i / per_side) + 0.5f) / per_side;
    const Vec3 x = corner + u * s + v * t + cell.normal * cell.offset;
    const LightPrimitive* strongest = nullptr;
    for (const uint32_t l : lights) {
      const LightPrimitive& p = scene.primitives[l];
      const double e = arriving(p, Vec3d(x), normal);
      a.all[i] += e;
      if (e <= a.strongest[i]) continue;
      a.strongest[i] = e;
      strongest = &p;
    }
    constexpr float short_of_it = 0.998f;
    a.towards[i].origin = x;
    a.towards[i].direction =
        strongest != nullptr ? nearest_point(*strongest, x) - x : Vec3(cell.normal);
    a.towards[i].t_max = strongest != nullptr ? short_of_it : 0;
  }
  return a;
}

}  // namespace

CellMap::IsUneven uneven_by_lights(const PreparedScene& scene) {
  return [&scene](const CellOutline& cell) {
    const auto& c = cell.corners;
    const Vec3 centre = (c[0] + c[2]) * 0.5f;
    const float distance = reach * std::max(length(c[1] - c[0]), length(c[3] - c[0]));
    thread_local std::vector<uint32_t> near;
    scene.light_tree.near(centre, distance, most_lights, near);
    if (near.size() == most_lights) return true;
    std::erase_if(near, [&](uint32_t p) {
      return !(distance_squared(scene.primitives[p].bounds, centre) < sqr(distance));
    });
    if (near.empty()) return false;
    const Arriving a = arriving_at(scene, near, cell);
    std::array<uint8_t, places> is_blocked{};
    scene.tracer.occluded(a.towards, is_blocked);
    double sum = 0, squares = 0;
    for (size_t i = 0; i < places; ++i) {
      const double e = a.all[i] - (is_blocked[i] != 0 ? a.strongest[i] : 0);
      sum += e;
      squares += sqr(e);
    }
    return squares * double(places) > sqr(sum) * (1 + sqr(most_spread));
  };
}

}  // namespace troffer
