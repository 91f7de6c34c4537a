// Closed-form irradiance against configuration factors from the literature and against quadrature:
// from 1e-4 to 1e3 source sizes away, with receivers tilted through 180 degrees.
// References: [1] Howell, Mengüç, Daun & Siegel, "Thermal Radiation Heat Transfer", 7th ed.,
//   appendix C: catalogue of configuration factors, B-3, B-4, B-13, B-15.
#include <doctest/doctest.h>

#include <cmath>

#include "light/irradiance.h"
#include "light/light_scene_set.h"
#include "support/quadrature.h"

using namespace troffer;
using namespace troffer::test;

namespace {

const std::vector<double> distances{1e-4, 1e-3, 1e-2, 0.1, 0.5, 1, 3, 10, 100, 1e3};

std::vector<Vec3d> rectangle(double a, double b, double z) {  // its front faces down
  return {{0, 0, z}, {0, b, z}, {a, b, z}, {a, 0, z}};
}

// Integrates f over [lo, hi], split at `focus` and at geometric distances from it.
template <class F>
double integrate_around(const F& f, double lo, double hi, double focus, double scale, int n) {
  std::vector<double> breaks{lo, hi};
  if (focus > lo && focus < hi) breaks.push_back(focus);
  for (double step = std::max(scale, 1e-6); step < hi - lo + std::abs(focus); step *= 2)
    for (const double b : {focus - step, focus + step})
      if (b > lo && b < hi) breaks.push_back(b);
  std::sort(breaks.begin(), breaks.end());
  double sum = 0;
  for (size_t i = 0; i + 1 < breaks.size(); ++i)
    if (breaks[i + 1] > breaks[i]) sum += integrate(f, breaks[i], breaks[i + 1], n);
  return sum;
}

// Reference by quadrature: a flat source in z = 0, front up, between the curves left(y) and
// right(y), y = ordinate(t), t in [t0,t1]. Integrates slices along x, each cut exactly at the
// horizon.
template <class Left, class Right, class Ordinate, class Slope>
double flat_reference(const Left& left, const Right& right, const Ordinate& ordinate,
                      const Slope& slope, double t0, double t1, double t_focus,
                      const std::vector<double>& extra, const Vec3d& x, const Vec3d& n) {
  const auto slice = [&](double t) {
    const double y = ordinate(t);
    double lo = left(y), hi = right(y);
    // n·(p - x) = n.x p.x + c > 0
    const double c = n.y * (y - x.y) - n.z * x.z - n.x * x.x;
    if (n.x > 0) lo = std::max(lo, -c / n.x);
    if (n.x < 0) hi = std::min(hi, -c / n.x);
    if (n.x == 0 && c <= 0) return 0.0;
    if (lo >= hi) return 0.0;
    const double away = std::hypot(y - x.y, x.z);
    const auto f = [&](double px) {
      const double square = (px - x.x) * (px - x.x) + away * away;
      return (n.x * px + c) * x.z / (square * square);
    };
    return integrate_around(f, lo, hi, x.x, away, 12) * slope(t);
  };
  // Outer breaks: the focus, and the crossings of horizon and outline.
  std::vector<double> breaks{t0, t1};
  for (const double b : extra)
    if (b > t0 && b < t1) breaks.push_back(b);
  std::sort(breaks.begin(), breaks.end());
  double sum = 0;
  for (size_t i = 0; i + 1 < breaks.size(); ++i)
    sum += integrate_around(slice, breaks[i], breaks[i + 1], t_focus, x.z, 12);
  return sum;
}

double rectangle_reference(double a, double b, const Vec3d& x, const Vec3d& n) {
  std::vector<double> kinks;  // y at which the horizon crosses x = 0 and x = a
  for (const double px : {0.0, a})
    if (n.y != 0) kinks.push_back(x.y + (n.z * x.z - n.x * (px - x.x)) / n.y);
  return flat_reference([](double) { return 0.0; }, [a](double) { return a; },
                        [](double t) { return t; }, [](double) { return 1.0; }, 0, b, x.y, kinks, x,
                        n);
}

// t is the polar angle from -y to y, so that the slices' ends vary smoothly.
double disk_reference(double radius, const Vec3d& x, const Vec3d& n) {
  std::vector<double> kinks;  // where the horizon crosses the rim
  const double middle = dot(n, x), swing = radius * std::hypot(n.x, n.y);
  if (std::abs(middle) < swing) {
    const double towards = std::atan2(n.y, n.x), half = std::acos(middle / swing);
    for (const double phi : {towards - half, towards + half})
      kinks.push_back(std::asin(std::clamp(std::sin(phi), -1.0, 1.0)));
  }
  const double focus = std::asin(std::clamp(x.y / radius, -1.0, 1.0));
  return flat_reference(
      [&](double y) { return -std::sqrt(std::max(0.0, (radius - y) * (radius + y))); },
      [&](double y) { return std::sqrt(std::max(0.0, (radius - y) * (radius + y))); },
      [&](double t) { return radius * std::sin(t); },
      [&](double t) { return radius * std::cos(t); }, -pi / 2, pi / 2, focus, kinks, x, n);
}

// Integrates rings of directions around the sphere's centre. The part of a ring above the horizon
// has a closed form.
double sphere_reference(double radius, double d, double theta_n) {
  const double theta_max = std::asin(radius / d);
  const auto ring = [&](double theta) {
    const double a = std::cos(theta) * std::cos(theta_n), b = std::sin(theta) * std::sin(theta_n);
    double value = 0;  // ∫ max(0, a + b cos(phi)) dphi
    if (a >= b)
      value = 2 * pi * a;
    else if (a > -b) {
      const double half = std::acos(-a / b);
      value = 2 * (a * half + b * std::sin(half));
    }
    return value * std::sin(theta);
  };
  const double kink = std::abs(pi / 2 - theta_n);
  // Adaptive, because the integrand behaves like a square root at the kink.
  if (kink > 0 && kink < theta_max)
    return integrate_adaptive(ring, 0.0, kink, 1e-13 * theta_max * theta_max, 10, 40) +
           integrate_adaptive(ring, kink, theta_max, 1e-13 * theta_max * theta_max, 10, 40);
  return integrate_adaptive(ring, 0.0, theta_max, 1e-13 * theta_max * theta_max, 10, 40);
}

// Normals tilted through 180 degrees in several azimuths, from facing the source (down) to facing
// away.
std::vector<Vec3d> tilted_normals() {
  std::vector<Vec3d> all;
  for (const double azimuth : {0.0, 0.9, 2.5, 4.0})
    for (int i = 0; i <= 12; ++i) {
      const double tilt = pi * i / 12;
      all.push_back({std::sin(tilt) * std::cos(azimuth), std::sin(tilt) * std::sin(azimuth),
                     -std::cos(tilt)});
    }
  return all;
}

// Checks |value - exact| <= 1e-6 exact + floor. The floor covers slivers above the horizon, where
// the reference itself suffers cancellation.
void check_close(double value, double exact, double floor) {
  CHECK(std::abs(value - exact) <= 1e-6 * exact + floor);
}

}  // namespace

TEST_CASE("parallel rectangle over a corner [1, B-3] and perpendicular rectangle [1, B-4]") {
  for (const double h : distances) {
    const double a = 1, b = 0.6;
    const double x = a / h, y = b / h;
    const double parallel = 0.5 * (x / std::sqrt(1 + x * x) * std::atan(y / std::sqrt(1 + x * x)) +
                                   y / std::sqrt(1 + y * y) * std::atan(x / std::sqrt(1 + y * y)));
    const double e = polygon_irradiance(rectangle(a, b, h), {0, 0, 0}, {0, 0, 1});
    CHECK(e == doctest::Approx(parallel).epsilon(1e-9));
    // The receiver is at distance h in front of the rectangle's lower corner, with its normal along
    // the rectangle. The rectangle lies in the plane y = h, with width b along x and height a along
    // z.
    const std::vector<Vec3d> wall{{0, h, 0}, {0, h, a}, {b, h, a}, {b, h, 0}};
    const std::vector<Vec3d> facing(wall.rbegin(), wall.rend());
    const double ca = a / b, cc = h / b, root = std::sqrt(ca * ca + cc * cc);
    const double perpendicular = 0.5 * (std::atan(1 / cc) - cc / root * std::atan(1 / root));
    const double w = polygon_irradiance(wall, {0, 0, 0}, {0, 0, 1}) +
                     polygon_irradiance(facing, {0, 0, 0}, {0, 0, 1});
    // Far away the printed formula itself suffers cancellation.
    CHECK(w == doctest::Approx(perpendicular).epsilon(h > 50 ? 1e-5 : 1e-8));
    CHECK(std::min(polygon_irradiance(wall, {}, {0, 0, 1}),
                   polygon_irradiance(facing, {}, {0, 0, 1})) == 0);
  }
}

TEST_CASE("disk: on the axis, off the axis [1, B-13], perpendicular [1, B-15]") {
  for (const double h : distances) {
    const double on_axis = disk_irradiance({0, 0, h}, {0, 0, -1}, 1, {}, {0, 0, 1});
    CHECK(on_axis == doctest::Approx(pi / (1 + h * h)).epsilon(1e-12));
    for (const double offset : {1e-3, 0.3, 0.999, 1.7, 40.0}) {
      // In units of the offset, as printed.
      const double hh = h / offset, r = 1 / offset, z = 1 + hh * hh + r * r;
      const double root = std::sqrt(z * z - 4 * r * r);
      const double b13 = pi / 2 * (1 - (z - 2 * r * r) / root);
      const double b15 = pi / 2 * hh * (z / root - 1);
      const Vec3d centre{offset, 0, h};
      // The printed forms suffer cancellation where the factor is small.
      CHECK(disk_irradiance(centre, {0, 0, -1}, 1, {}, {0, 0, 1}) ==
            doctest::Approx(b13).epsilon(1e-9 + 1e-13 / b13));
      // A normal parallel to the plane sees only half of it; here that half contains the whole
      // disk.
      if (offset > 1)
        CHECK(disk_irradiance(centre, {0, 0, -1}, 1, {}, {1, 0, 0}) ==
              doctest::Approx(b15).epsilon(1e-9 + 1e-13 * (1 + hh) / b15));
    }
  }
}

TEST_CASE("sphere: above the horizon, cut by it, touching, inside") {
  for (const double h : {1e-4, 1e-3, 1e-2, 0.1, 1.0, 10.0, 1e3}) {
    const double d = 1 + h;
    for (int i = 0; i <= 24; ++i) {
      const double theta = pi * i / 24;
      const Vec3d n{std::sin(theta), 0, std::cos(theta)};
      const double exact = sphere_reference(1, d, theta);
      check_close(sphere_irradiance({0, 0, d}, 1, {}, n), exact, 1e-12 / (d * d));
    }
    const double root = std::sqrt(d * d - 1);  // [1]: element whose plane passes the centre
    CHECK(sphere_irradiance({0, 0, d}, 1, {}, {1, 0, 0}) ==
          doctest::Approx(std::atan(1 / root) - root / (d * d)).epsilon(1e-7));
  }
  CHECK(sphere_irradiance({0, 0, 0.3}, 1, {}, {1, 0, 0}) == 0);
  CHECK(sphere_irradiance({0, 0, 0.3}, 1, {}, {1, 0, 0}, Sides::front, true) == pi);
  CHECK(sphere_irradiance({0, 0, 0.3}, 1, {}, {1, 0, 0}, Sides::both) == pi);
  CHECK(sphere_irradiance({0, 0, 3}, 1, {}, {0, 0, 1}, Sides::front, true) == 0);
}

TEST_CASE(
    "rectangles at arbitrary places, receivers tilted through 180 degrees, against quadrature") {
  const double a = 1, b = 0.7;
  const std::vector<Vec3d> source{{0, 0, 0}, {a, 0, 0}, {a, b, 0}, {0, b, 0}};
  const Scene scene = polygon_scene(source, false, Pose{Framed(Vec3d{0, 0, 1}), {}});
  const SourceSurface surface(scene, 0);
  const std::vector<Vec3d> directions{{0, 0, 1}, {0.6, 0, 0.8}, {0.5, 0.7, 0.1}, {-0.9, 0.3, 0.01}};
  const std::vector<Vec3d> starts{{0.4, 0.3, 0}, {0.01, 0.35, 0}, {1, 0.7, 0}};
  for (const double d : distances)
    for (size_t k = 0; k < directions.size(); ++k) {
      const Vec3d x{rounded(starts[k % starts.size()] + normalize(directions[k]) * d)};
      for (const Vec3d& unrounded : tilted_normals()) {
        const Vec3d n{rounded(unrounded)};  // the normal that the float function receives
        const double exact = rectangle_reference(a, 0.7f, x, n);
        const double floor = 1e-9 * std::min(1.0, 1 / (d * d));
        check_close(polygon_irradiance(
                        std::vector<Vec3d>{{0, 0, 0}, {a, 0, 0}, {a, 0.7f, 0}, {0, 0.7f, 0}}, x, n),
                    exact, floor);
        const double fast = double(cell_irradiance(surface.parallelogram(), {}, Vec3(x), Vec3(n)));
        CHECK_MESSAGE(std::abs(fast - exact) <= 3e-6 * exact + 2e-7 * std::min(1.0, 1 / (d * d)),
                      "d " << d << " direction " << k << ": " << fast << " not " << exact);
      }
    }
}

TEST_CASE("disks at arbitrary places, receivers tilted through 180 degrees, against quadrature") {
  const double radius = 0.8;
  const std::vector<Vec3d> directions{{0, 0, 1}, {0.6, 0, 0.8}, {0.5, 0.7, 0.1}, {-0.9, 0.3, 0.01}};
  const std::vector<Vec3d> starts{{0, 0, 0}, {0.3, -0.5, 0}, {0.8, 0, 0}, {0, 0.79, 0}};
  for (const double d : distances)
    for (size_t k = 0; k < directions.size(); ++k) {
      const Vec3d x = starts[k] + normalize(directions[k]) * d;
      for (const Vec3d& unrounded : tilted_normals()) {
        const Vec3d n = normalize(unrounded);
        const double exact = disk_reference(radius, x, n);
        check_close(disk_irradiance({}, {0, 0, 1}, radius, x, n), exact,
                    1e-8 * std::min(1.0, 1 / (d * d)));
        CHECK(disk_irradiance({}, {0, 0, -1}, radius, x, n) == 0);
        CHECK(disk_irradiance({}, {0, 0, -1}, radius, x, n, Sides::both) ==
              disk_irradiance({}, {0, 0, 1}, radius, x, n));
      }
    }
}

TEST_CASE("parts sum to the whole: fans, cells of a parallelogram, and a mesh of the same shape") {
  Random random(3);
  const Pose pose;
  const auto number = [&] { return random.next_double() * 2 - 1; };
  for (int round = 0; round < 200; ++round) {
    const Vec3d u{number(), number(), number()}, v{number(), number(), number()},
        o{number(), number(), number()};
    const std::vector<Vec3d> quad{o, o + u, o + u + v, o + v};
    const Scene scene = polygon_scene(quad, true, pose);
    const Scene mesh = mesh_scene(quad, {{0, 1, 2}, {0, 2, 3}}, pose);
    const LightPrimitives whole(scene), parts(mesh);
    if (whole.size() != 1 || whole[0].area < 0.05f) continue;
    const double far = std::pow(10.0, 2 * random.next_double() - 1);
    const Vec3 x = pose.world(Vec3d{number(), number(), number()} * far);
    const Vec3 n(normalize(Vec3d{number(), number(), number()}));
    const double exact = irradiance(whole[0], Vec3d(x), Vec3d(n));
    const SourceSurface surface(scene, 0);
    REQUIRE(surface.is_parallelogram());
    double sum = 0;
    const int side = 1 << (round % 4);
    for (int i = 0; i < side; ++i)
      for (int j = 0; j < side; ++j) {
        const float w = 1.0f / float(side);
        const SourceCell cell{float(i) * w, float(i + 1) * w, float(j) * w, float(j + 1) * w};
        sum += double(cell_irradiance(surface.parallelogram(), cell, x, n, Sides::both));
      }
    CHECK(std::abs(sum - exact) <= 2e-6 * exact + 1e-7 / (far * far));
    // The mesh is one-sided: the same value from its front, nothing from behind.
    const bool is_front = dot(whole[0].normal, Vec3d(x) - Vec3d(whole[0].centroid)) > 0;
    const double of_mesh = irradiance(parts, 0, Vec3d(x), Vec3d(n));
    CHECK(std::abs(of_mesh - (is_front ? exact : 0)) <= 1e-6 * exact + 1e-7 / (far * far));
  }
}

TEST_CASE("irradiance inside a closed room of sources is pi, whatever the normal") {
  // A box of six faces seen from inside; the terms of Lambert's formula must sum to the full
  // hemisphere.
  Random random(8);
  const auto number = [&] { return random.next_double() * 1.8 - 0.9; };
  for (int round = 0; round < 100; ++round) {
    const Vec3d x{number(), number(), number()};
    const Vec3d n = normalize(Vec3d{number(), number(), number()});
    double sum = 0;
    for (size_t axis = 0; axis < 3; ++axis)
      for (const double side : {-1.0, 1.0}) {
        Vec3d e, f, c;
        c[axis] = side;
        e[(axis + 1) % 3] = 1;
        f[(axis + 2) % 3] = side;
        const std::vector<Vec3d> face{c - e - f, c - e + f, c + e + f, c + e - f};
        sum += polygon_irradiance(face, x, n);
      }
    CHECK(sum == doctest::Approx(pi).epsilon(1e-12));
  }
}
