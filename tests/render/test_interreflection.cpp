// Measurements in rooms and between plates with reflection, against an independent solution.
#include <doctest/doctest.h>

#include <cmath>

#include "render/measure.h"
#include "render/pictures.h"
#include "support/rectangles.h"

using namespace troffer;
using namespace troffer::test;

namespace {

// Two plates that face each other, one of which emits.
std::vector<Rectangle> facing_plates() {
  return {{{0, 0, 0}, {2, 0, 0}, {0, 2, 0}, 0.8, 0}, {{0, 0, 1}, {0, 2, 0}, {2, 0, 0}, 0.6, 1}};
}

// Two perpendicular plates with a common edge.
std::vector<Rectangle> perpendicular_plates() {
  return {{{0, 0, 0}, {2, 0, 0}, {0, 2, 0}, 0.8, 0}, {{0, 0, 0}, {0, 2, 0}, {0, 0, 1.5}, 0.6, 1}};
}

// 4 × 4 × 3 m, with a light of 1 × 1 m in the ceiling.
std::vector<Rectangle> room() {
  std::vector<Rectangle> r{{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, 0.3, 0},
                           {{0, 0, 0}, {0, 0, 3}, {4, 0, 0}, 0.5, 0},
                           {{0, 4, 0}, {4, 0, 0}, {0, 0, 3}, 0.5, 0},
                           {{0, 0, 0}, {0, 4, 0}, {0, 0, 3}, 0.7, 0},
                           {{4, 0, 0}, {0, 0, 3}, {0, 4, 0}, 0.5, 0}};
  const double cuts[] = {0, 1.5, 2.5, 4};
  for (size_t i = 0; i < 3; ++i)
    for (size_t j = 0; j < 3; ++j) {
      const bool shines = i == 1 && j == 1;
      r.push_back({{cuts[i], cuts[j], 3},
                   {0, cuts[j + 1] - cuts[j], 0},
                   {cuts[i + 1] - cuts[i], 0, 0},
                   shines ? 0.0 : 0.8,
                   shines ? 10.0 : 0.0});
    }
  return r;
}

void check_points(const std::vector<Rectangle>& rectangles, double size,
                  const std::vector<MeasuringPoint>& points) {
  const ExtrapolatedSolution solution(rectangles, size);
  const PreparedScene scene(scene_of(rectangles));
  MeasureOptions o;
  o.spp = 1 << 14;
  o.threads = 2;
  const MeasureResult r = measure(scene, points, o, {}, never_stopped);
  for (size_t i = 0; i < points.size(); ++i) {
    const Vec3d n = Vec3d(points[i].normal);
    const double expected = solution.irradiance(points[i].position, n);
    CAPTURE(i);
    CAPTURE(solution.doubt(points[i].position, n) / expected);
    CAPTURE(r.values[i].standard_error / r.values[i].illuminance_lx);
    CHECK(double(r.values[i].irradiance.g) == doctest::Approx(expected).epsilon(0.003));
  }
}

}  // namespace

TEST_CASE("measure: parallel plates") {
  check_points(facing_plates(), 0.25,
               {{{1, 1, 0}, {0, 0, 1}}, {{0.1, 0.2, 0}, {0, 0, 1}}, {{1.9, 1, 1}, {0, 0, -1}}});
}

TEST_CASE("measure: perpendicular plates") {
  check_points(perpendicular_plates(), 0.125,
               {{{0.05, 1, 0}, {0, 0, 1}}, {{1, 0.3, 0}, {0, 0, 1}}, {{0, 1, 0.7}, {1, 0, 0}}});
}

TEST_CASE("measure: a room with a light in its ceiling") {
  std::vector<MeasuringPoint> points;
  for (const double x : {0.4, 1.1, 2.0, 3.4}) points.push_back({{x, 1.3, 0.85}, {0, 0, 1}});
  points.push_back({{0.3, 0.4, 0}, {0, 0, 1}});
  points.push_back({{0.7, 2, 3}, {0, 0, -1}});
  points.push_back({{0, 2, 1.2}, {1, 0, 0}});
  points.push_back({{4, 0.5, 2.5}, {-1, 0, 0}});
  check_points(room(), 0.5, points);
}
