// Warps: inverses, densities by Jacobians, and χ² tests.
#include <doctest/doctest.h>

#include <vector>

#include "base/random.h"
#include "base/warp.h"
#include "support/chi_square.h"

using namespace troffer;
using namespace troffer::test;

namespace {

constexpr double h = 1e-6;

// |∂(x,y)/∂(u,v)| of a map from the square to the plane.
template <class Map>
double plane_jacobian(const Map& map, const Vec2d& u) {
  const Vec2d a = map(Vec2d{u.x + h, u.y}) - map(Vec2d{u.x - h, u.y});
  const Vec2d b = map(Vec2d{u.x, u.y + h}) - map(Vec2d{u.x, u.y - h});
  return std::abs(a.x * b.y - a.y * b.x) / (4 * h * h);
}

}  // namespace

TEST_CASE("disk map: inverse, area, unit radius") {
  Random random(1);
  for (int i = 0; i < 20000; ++i) {
    const Vec2d u{random.next_double(), random.next_double()};
    const Vec2d p = disk_from_square(u), back = square_from_disk(p);
    CHECK(p.x * p.x + p.y * p.y <= 1 + 1e-12);
    CHECK(back.x == doctest::Approx(u.x).epsilon(1e-9));
    CHECK(back.y == doctest::Approx(u.y).epsilon(1e-9));
    const double a = 2 * u.x - 1, b = 2 * u.y - 1;
    if (i < 2000 && std::abs(std::abs(a) - std::abs(b)) > 1e-4 && std::abs(a) + std::abs(b) > 1e-2)
      CHECK(plane_jacobian([](const Vec2d& v) { return disk_from_square(v); }, u) ==
            doctest::Approx(pi).epsilon(1e-4));
  }
  CHECK(disk_from_square(Vec2d{0.5, 0.5}) == Vec2d{0, 0});
  CHECK(square_from_disk(Vec2d{0, 0}) == Vec2d{0.5, 0.5});
}

TEST_CASE("triangle map: inverse, area, inside") {
  Random random(2);
  for (int i = 0; i < 20000; ++i) {
    const Vec2d u{random.next_double(), random.next_double()};
    const Vec2d b = triangle_from_square(u), back = square_from_triangle(b);
    CHECK((b.x >= 0 && b.y >= 0 && b.x + b.y <= 1 + 1e-12));
    CHECK(back.x == doctest::Approx(u.x).epsilon(1e-9));
    CHECK(back.y == doctest::Approx(u.y).epsilon(1e-9));
    if (i < 2000 && u.x > 1e-3)
      CHECK(plane_jacobian([](const Vec2d& v) { return triangle_from_square(v); }, u) ==
            doctest::Approx(0.5).epsilon(1e-4));
  }
}

TEST_CASE("directions: unit length, inverse, χ² against their densities") {
  Random random(3);
  constexpr int rows = 16, columns = 16, n = 200000;
  std::vector<double> cosine(rows * columns), sphere(rows * columns), expected_cosine,
      expected_sphere(rows * columns, double(n) / (rows * columns));
  int bad = 0;
  for (int i = 0; i < n; ++i) {
    const Vec2 u = random.next_vec2();
    const auto column = [](const Vec3& w) {
      const double phi = std::atan2(double(w.y), double(w.x)) + pi;
      return std::min(size_t(phi / (2 * pi) * columns), size_t(columns - 1));
    };
    const Vec3 c = cosine_hemisphere_from_square(u), s = sphere_from_square(u);
    cosine[size_t(std::min(c.z, 0.9999999f) * rows) * columns + column(c)] += 1;
    sphere[size_t(std::min((s.z + 1) / 2, 0.9999999f) * rows) * columns + column(s)] += 1;
    const Vec2 cu = square_from_cosine_hemisphere(c), su = square_from_sphere(s);
    bad += std::abs(length(c) - 1) > 1e-5f || std::abs(length(s) - 1) > 1e-5f;
    bad += std::abs(cu.x - u.x) > 1e-5f || std::abs(cu.y - u.y) > 1e-5f;
    // azimuth is ill-conditioned at the poles
    const float r2 = s.x * s.x + s.y * s.y;
    bad += std::abs(su.x - u.x) > 1e-5f || (r2 > 1e-4f && std::abs(su.y - u.y) > 1e-4f);
  }
  CHECK(bad == 0);
  for (int r = 0; r < rows; ++r)  // ∫ cos / pi over a ring: z1² - z0²
    for (int c = 0; c < columns; ++c)
      expected_cosine.push_back(n * double(sqr(r + 1) - sqr(r)) / (rows * rows) / columns);
  const auto a = chi_square_test(cosine, expected_cosine, 1, sidak(1e-3, 2));
  CHECK_MESSAGE(a.is_accepted, a.text());
  const auto b = chi_square_test(sphere, expected_sphere, 1, sidak(1e-3, 2));
  CHECK_MESSAGE(b.is_accepted, b.text());
  CHECK(pdf_cosine_hemisphere(0.5f) == doctest::Approx(0.5 / pi));
  CHECK(pdf_cosine_hemisphere(-0.5f) == 0);
}
