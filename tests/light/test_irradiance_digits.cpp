// Closed forms against quadrature where they suffer cancellation: slivers, grazing horizons,
// receivers near the source's plane or far away.
#include <doctest/doctest.h>

#include <cmath>

#include "light/irradiance.h"
#include "support/irradiance_reference.h"

using namespace troffer;
using namespace troffer::test;

namespace {

constexpr double least = 1e-10 * pi;  // irradiance below this is not compared

struct Worst {
  double error = 0;
  int compared = 0;
  void add(double value, double expected) {
    if (!(expected > least)) return;
    ++compared;
    error = std::max(error, std::abs(value / expected - 1));
  }
};

}  // namespace

TEST_CASE("polygons and parts of parallelograms keep their precision") {
  Worst polygon, cell;
  for (uint64_t seed = 0; seed < 4000; ++seed) {
    Random r(seed);
    const RandomPolygon p = random_polygon(r);
    const std::vector<Vec3d>& corners = p.corners;
    const Vec3d inside = corners[size_t(r.next_double() * double(corners.size()))];
    const HardReceiver h = hard_receiver(r, inside, p.m, p.size);
    const Vec3d x(h.position), n(h.normal);
    polygon.add(polygon_irradiance(corners, x, n, Sides::both),
                polygon_reference(corners, p.m, x, n));
    const Parallelogram source{corners[0], corners[1] - corners[0], corners[2] - corners[0], p.m};
    const SourceCell part{0.25f, 0.75f, 0.5f, 0.625f};
    const auto at = [&](double u, double v) { return source.origin + source.u * u + source.v * v; };
    const std::vector<Vec3d> outline{at(0.25, 0.5), at(0.75, 0.5), at(0.75, 0.625),
                                     at(0.25, 0.625)};
    cell.add(double(cell_irradiance(source, part, h.position, h.normal, Sides::both)),
             polygon_reference(outline, p.m, x, n));
  }
  MESSAGE(polygon.compared, " polygons: ", polygon.error, ", ", cell.compared,
          " cells: ", cell.error);
  CHECK(polygon.compared > 1500);
  CHECK(polygon.error < 1e-4);
  CHECK(cell.compared > 1000);
  CHECK(cell.error < 1e-4);
}

TEST_CASE("disks and spheres keep their precision") {
  Worst disk, sphere;
  for (uint64_t seed = 0; seed < 1500; ++seed) {
    Random r(seed + 9000);
    const double radius = std::pow(10.0, -2 + 2 * r.next_double()), angle = 3 * r.next_double();
    const Vec3d m{std::sin(angle), 0, std::cos(angle)};
    const HardReceiver h = hard_receiver(r, {0, 0, 0}, m, radius);
    const Vec3d x(h.position), n(h.normal);
    // Closer to the disk's plane the quadrature fails, not the closed form.
    if (std::abs(dot(x, m)) > 2e-3 * radius)
      disk.add(disk_irradiance({0, 0, 0}, m, radius, x, n, Sides::both),
               disk_reference({0, 0, 0}, m, radius, x, n));
    if (length(x) > radius * 1.001)
      sphere.add(sphere_irradiance({0, 0, 0}, radius, x, n),
                 sphere_reference({0, 0, 0}, radius, x, n));
    // A sliver of the sphere above or below the horizon.
    const double distance = radius * std::pow(10.0, 0.01 + 2 * r.next_double());
    const double sine = radius / distance * (2 * r.next_double() - 1 < 0 ? -1 : 1) *
                        (1 - std::pow(10.0, -4 * r.next_double()));
    const Vec3d low{std::sqrt(1 - sine * sine), 0, sine};
    sphere.add(sphere_irradiance(low * distance, radius, {0, 0, 0}, {0, 0, 1}),
               sphere_reference(low * distance, radius, {0, 0, 0}, {0, 0, 1}));
  }
  MESSAGE(disk.compared, " disks: ", disk.error, ", ", sphere.compared, " spheres: ", sphere.error);
  CHECK(disk.compared > 500);
  CHECK(disk.error < 1e-4);
  CHECK(sphere.compared > 1000);
  CHECK(sphere.error < 1e-4);
}
