// Maps between the square and all directions: inverses, areas, and continuity across edges.
#include <doctest/doctest.h>

#include <cmath>

#include "base/random.h"
#include "base/sphere_map.h"

using namespace troffer;

namespace {

constexpr SphereMap maps[] = {SphereMap::lat_long, SphereMap::equal_area};

}  // namespace

TEST_CASE("the maps between directions and squares are inverse to each other") {
  Random random(1);
  for (const SphereMap map : maps)
    for (int i = 0; i < 20000; ++i) {
      const Vec2 uv = random.next_vec2();
      const Vec3 w = direction_from_square(map, uv);
      REQUIRE(std::abs(length(w) - 1) < 1e-5f);
      const Vec2 back = square_from_direction(map, w);
      // Azimuths are coarse near the poles of lat_long.
      const float slack =
          map == SphereMap::lat_long ? 1e-5f / std::max(1e-3f, std::hypot(w.x, w.y)) : 1e-3f;
      REQUIRE(std::abs(back.x - uv.x) < slack);
      REQUIRE(std::abs(back.y - uv.y) < 1e-3f);
    }
}

TEST_CASE("the solid angle of a small square is its area times the stated factor") {
  Random random(2);
  for (const SphereMap map : maps)
    for (int i = 0; i < 2000; ++i) {
      const float h = 1e-2f;
      Vec2 uv{0.02f + 0.95f * random.next_float(), 0.02f + 0.95f * random.next_float()};
      // The octahedron's edges are folds.
      const float x = std::abs(2 * uv.x - 1), y = std::abs(2 * uv.y - 1);
      if (map == SphereMap::equal_area &&
          (std::abs(x + y - 1) < 0.1f || x < 0.05f || y < 0.05f || x > 0.95f || y > 0.95f))
        continue;
      const Vec3 a = direction_from_square(map, {uv.x - h / 2, uv.y}),
                 b = direction_from_square(map, {uv.x + h / 2, uv.y}),
                 c = direction_from_square(map, {uv.x, uv.y - h / 2}),
                 d = direction_from_square(map, {uv.x, uv.y + h / 2});
      const float area = length(cross(b - a, d - c)) / (h * h);
      CHECK(double(area) == doctest::Approx(double(solid_angle_per_area(map, uv.y))).epsilon(0.01));
    }
}

TEST_CASE("the middle of an equal-area map is +z, its corners are -z, and its axes are correct") {
  CHECK(length(equal_area_direction({0.5f, 0.5f}) - Vec3{0, 0, 1}) < 1e-6f);
  CHECK(length(equal_area_direction({1, 0.5f}) - Vec3{1, 0, 0}) < 1e-6f);
  CHECK(length(equal_area_direction({0.5f, 1}) - Vec3{0, 1, 0}) < 1e-6f);
  for (const Vec2 corner : {Vec2{0, 0}, Vec2{1, 0}, Vec2{0, 1}, Vec2{1, 1}})
    CHECK(length(equal_area_direction(corner) - Vec3{0, 0, -1}) < 1e-6f);
  CHECK(length(lat_long_direction({0.25f, 0.5f}) - Vec3{0, 1, 0}) < 1e-6f);
  CHECK(length(lat_long_direction({0.3f, 0}) - Vec3{0, 0, 1}) < 1e-6f);
}

TEST_CASE("texels beyond an edge are their neighbours on the sphere") {
  constexpr int n = 64;
  for (const SphereMap map : maps) {
    const int width = map == SphereMap::lat_long ? 2 * n : n;
    const auto centre = [&](size_t i) {
      return direction_from_square(map, {(float(i % size_t(width)) + 0.5f) / float(width),
                                         (float(i / size_t(width)) + 0.5f) / n});
    };
    for (int k = 0; k < n; ++k) {
      const float near = 3.0f / n * pi_f;
      CHECK(length(centre(texel_on_sphere(map, width, n, -1, k)) -
                   centre(texel_on_sphere(map, width, n, 0, k))) < near);
      CHECK(length(centre(texel_on_sphere(map, width, n, width, k)) -
                   centre(texel_on_sphere(map, width, n, width - 1, k))) < near);
      CHECK(length(centre(texel_on_sphere(map, width, n, k, -1)) -
                   centre(texel_on_sphere(map, width, n, k, 0))) < near);
      CHECK(length(centre(texel_on_sphere(map, width, n, k, n)) -
                   centre(texel_on_sphere(map, width, n, k, n - 1))) < near);
    }
  }
}
