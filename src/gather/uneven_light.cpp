#include "gather/uneven_light.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "base/units.h"
#include "light/irradiance.h"

namespace troffer {

namespace {

constexpr float reach = 3;  // distance to lights that are looked at, in widths of the cell
constexpr double most_spread =
    0.5;  // largest standard deviation of irradiance over a cell, relative to its mean
// With more pieces of lights nearby a cell counts as uneven; smaller cells have fewer.
constexpr size_t most_lights = 1024;
constexpr int per_side = 3;  // test places along either side of a cell
constexpr size_t places = size_t(per_side) * per_side;
constexpr uint32_t far_draws = 16;  // light samples that estimate light from farther away

float distance_squared(const Box& b, const Vec3& x) {
  return length_squared(max(max(b.lower - x, x - b.upper), Vec3(0)));
}

// Returns about the width of a piece of a light at its narrowest; of a disk or sphere the radius.
float breadth(const LightPrimitive& p) {
  if (p.shape == PrimitiveShape::sphere) return p.radius;
  return p.radius > 0 ? p.area / (pi_f * p.radius) : 0;
}

// Returns the luminance of unoccluded irradiance from a piece of a light at x.
double arriving(const LightPrimitive& p, const Vec3d& x, const Vec3d& n) {
  if (p.shape != PrimitiveShape::point)
    return irradiance(p, x, n) * double(luminance(p.mean_radiance));
  const Vec3d d = Vec3d(p.centroid) - x;
  const double d2 = length_squared(d);
  return d2 > 0 ? double(p.tree_power) / (4 * pi) * std::max(dot(d, n), 0.0) / (d2 * std::sqrt(d2))
                : 0;
}

// Estimates irradiance from lights that are not in `near`, except those at infinity. It is about
// the same all over the cell.
double arriving_from_far(const PreparedScene& scene, const std::vector<uint32_t>& near,
                         const Vec3& x, const Vec3& n) {
  double sum = 0;
  for (uint32_t k = 0; k < far_draws; ++k) {
    const LightChoice c = scene.light_tree.choose(x, n, false, (float(k) + 0.5f) / far_draws);
    if (!(c.pmf > 0) || scene.primitives[c.primitive].is_infinite() ||
        std::find(near.begin(), near.end(), c.primitive) != near.end())
      continue;
    sum += arriving(scene.primitives[c.primitive], Vec3d(x), Vec3d(n)) / double(c.pmf);
  }
  return sum / far_draws;
}

// Returns the point of a light nearest to x; for polygons the nearest one of their bounds and
// plane.
Vec3 nearest_point(const LightPrimitive& p, const Vec3& x) {
  if (p.vertex_count == 0) return p.centroid;
  const Vec3 inside = max(min(x, p.bounds.upper), p.bounds.lower), n(p.normal);
  const Vec3 in_plane = inside - n * dot(inside - p.centroid, n);
  return max(min(in_plane, p.bounds.upper), p.bounds.lower);
}

// Irradiance at the test places of a cell.
struct Arriving {
  std::array<double, places> all{}, strongest{};
  std::array<Ray, places> towards;  // rays to the strongest light
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

bool is_unevenly_lit(const PreparedScene& scene, const CellOutline& cell) {
  const auto& c = cell.corners;
  const Vec3 centre = (c[0] + c[2]) * 0.5f;
  const float distance = reach * std::max(length(c[1] - c[0]), length(c[3] - c[0]));
  std::vector<uint32_t> near;
  scene.light_tree.near(centre, distance, most_lights, near);
  if (near.size() == most_lights) return true;
  // Light from a broad source differs little over a narrower cell.
  std::erase_if(near, [&](uint32_t i) {
    const LightPrimitive& p = scene.primitives[i];
    return !(distance_squared(p.bounds, centre) < sqr(distance)) || breadth(p) > distance;
  });
  if (near.empty()) return false;
  const Arriving a = arriving_at(scene, near, cell);
  std::array<uint8_t, places> is_blocked{};
  scene.tracer.occluded(a.towards, is_blocked);
  const double far =
      arriving_from_far(scene, near, centre + cell.normal * cell.offset, cell.normal);
  double sum = 0, squares = 0;
  for (size_t i = 0; i < places; ++i) {
    const double e = far + a.all[i] - (is_blocked[i] != 0 ? a.strongest[i] : 0);
    sum += e;
    squares += sqr(e);
  }
  return squares * double(places) > sqr(sum) * (1 + sqr(most_spread));
}

}  // namespace troffer
