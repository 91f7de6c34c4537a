// Grids, statistics and isolines compared with their definitions.
#include <doctest/doctest.h>

#include <cmath>

#include "report/grid.h"
#include "report/isolines.h"
#include "report/statistics.h"
#include "report/surface.h"

using namespace troffer;

TEST_CASE("grid cells are no larger than 0.2 · 5^(log10 d) or 10 m") {
  CHECK(largest_cell(1) == doctest::Approx(0.2));
  CHECK(largest_cell(10) == doctest::Approx(1));
  CHECK(largest_cell(100) == doctest::Approx(5));
  CHECK(largest_cell(1e4) == 10);
  struct Row {
    double d;
    int least;  // from the standard's table of points
  };
  for (const Row& r :
       {Row{0.4, 3}, {0.6, 3}, {1, 5}, {2, 6}, {5, 8}, {10, 10}, {25, 12}, {50, 17}, {100, 20}}) {
    const GridShape g = grid_shape(r.d, r.d);
    CAPTURE(r.d);
    CHECK(g.columns == g.rows);
    CHECK(g.columns >= r.least);
    CHECK(g.columns <= r.least + 2);
    CHECK(r.d / g.columns <= largest_cell(r.d) * (1 + 1e-4));
  }
  CHECK(grid_shape(10, 10).columns == 10);
}

TEST_CASE(
    "sides of grid cells have a ratio between .5 and 2, and d is the shorter side of long areas") {
  for (double w = 0.05; w < 300; w *= 1.31)
    for (double h = 0.05; h < 300; h *= 1.37) {
      const GridShape g = grid_shape(w, h), turned = grid_shape(h, w);
      CAPTURE(w);
      CAPTURE(h);
      CHECK(g.columns == turned.rows);
      const double ratio = (w / g.columns) / (h / g.rows);
      CHECK(ratio >= 0.5);
      CHECK(ratio <= 2);
    }
  // A corridor: d = 2, p = .325, 7 cells of .286 m across and 105 along.
  const GridShape corridor = grid_shape(30, 2);
  CHECK(corridor.rows == 7);
  CHECK(corridor.columns == 105);
  // Less than twice as long: d = 3.9, p = .518.
  CHECK(grid_shape(3.9, 2).columns == 8);
  // A desk, with rounding to float.
  for (const double w : {1.6, double(1.6f), double(4.4f) - double(2.8f)})
    for (const double h : {0.8, double(0.8f), double(2.56f) - double(1.76f)}) {
      CHECK(grid_shape(w, h).columns == 10);
      CHECK(grid_shape(w, h).rows == 5);
    }
  CHECK(border_zone(10, 8) == 0.5);
  CHECK(border_zone(2, 10) == doctest::Approx(0.3));
}

TEST_CASE("a rectangle of two triangles: its grid, off the border") {
  const Vec3d n{0, 0, 1};
  AssessedSurface s = surface_of_triangles(
      {{Vec3d{1, 2, 3}, {5, 2, 3}, {5, 5, 3}}, {Vec3d{1, 2, 3}, {5, 5, 3}, {1, 5, 3}}}, n);
  CHECK(s.width == doctest::Approx(4));
  CHECK(s.height == doctest::Approx(3));
  CHECK(s.area == doctest::Approx(12));
  CHECK(s.rim.size() == 4);
  CHECK(s.along.x == doctest::Approx(1));
  CHECK(dot(s.normal(), n) == doctest::Approx(1));
  CHECK(length(s.corner - Vec3d{1, 2, 3}) < 1e-12);
  s.border = 0.4;
  const SurfaceGrid g = grid_of(s);
  CHECK(g.points.size() == size_t(g.shape.columns * g.shape.rows));
  for (const GridPoint& p : g.points) {
    CHECK(p.position.x > 1.4);
    CHECK(p.position.x < 4.6);
    CHECK(p.position.y > 2.4);
    CHECK(p.position.y < 4.6);
    CHECK(p.position.z == 3);
  }
  CHECK(g.points[1].position.x - g.points[0].position.x == doctest::Approx(3.2 / g.shape.columns));
}

TEST_CASE("an L-shaped grid has no points in its notch, and a tiny area has one point") {
  const Vec3d n{0, 1, 0};
  const std::vector<std::array<Vec3d, 3>> l{{Vec3d{0, 0, 0}, {0, 0, 2}, {6, 0, 2}},
                                            {Vec3d{0, 0, 0}, {6, 0, 2}, {6, 0, 0}},
                                            {Vec3d{0, 0, 2}, {0, 0, 6}, {2, 0, 6}},
                                            {Vec3d{0, 0, 2}, {2, 0, 6}, {2, 0, 2}}};
  AssessedSurface s = surface_of_triangles(l, n);
  CHECK(s.area == doctest::Approx(20));
  for (const GridPoint& p : grid_of(s).points) CHECK((p.position.x < 2 || p.position.z < 2));
  s = surface_of_triangles({{Vec3d{0, 0, 0}, {0, 0, 1e-3}, {1e-3, 0, 0}}}, n);
  s.border = 0.5;
  const SurfaceGrid g = grid_of(s);
  REQUIRE(g.points.size() == 1);
  CHECK(g.points[0].position.x + g.points[0].position.z < 1e-3);
}

TEST_CASE("mean, minimum and uniformity, with errors") {
  const GridSummary s = summary_of({{400, 4}, {500, 6}, {600, 2}});
  CHECK(s.mean.value == doctest::Approx(500));
  CHECK(s.mean.error == doctest::Approx(4));
  CHECK(s.least.value == 400);
  CHECK(s.least.error == 4);
  CHECK(s.most.value == 600);
  CHECK(s.uniformity.value == doctest::Approx(0.8));
  CHECK(s.uniformity.error == doctest::Approx(std::hypot(4.0, 0.8 * 4) / 500));
  CHECK(std::abs(s.least_bias) < 0.5);  // no other value comes near
  CHECK_FALSE(summary_of({}).has_values);
  // The minimum of n equal values with normal errors of 1 follows order statistics.
  const GridSummary equal = summary_of(std::vector<Figure>(10, {100, 1}));
  CHECK(equal.least_bias == doctest::Approx(-1.5388).epsilon(0.06));
  CHECK(summary_of(std::vector<Figure>(10, {100, 0})).least_bias == 0);
}

TEST_CASE("isolines of a cone are closed circles") {
  ValueGrid g{41, 41, {}};
  for (int r = 0; r < 41; ++r)
    for (int c = 0; c < 41; ++c) g.values.push_back(100 - std::hypot(c - 20.0, r - 20.0));
  const std::vector<Line> lines = isolines(g, 90.25);
  REQUIRE(lines.size() == 1);
  CHECK(lines[0].size() > 40);
  CHECK(lines[0].front() == lines[0].back());
  for (const Vec2d& p : lines[0])
    CHECK(std::hypot(p.x - 20.5, p.y - 20.5) == doctest::Approx(9.75).epsilon(0.005));
  CHECK(isolines(g, 200).empty());
  // Missing values open the line.
  g.values[20 * 41 + 30] = std::nan("");
  const std::vector<Line> open = isolines(g, 90.25);
  REQUIRE(open.size() == 1);
  CHECK_FALSE(open[0].front() == open[0].back());
}

TEST_CASE("a saddle has two lines, joined by the value in its middle") {
  const ValueGrid low{2, 2, {1, 0, 0, 1}}, high{2, 2, {1, 0.3, 0.3, 1}};
  CHECK(isolines(low, 0.6).size() == 2);
  CHECK(isolines(high, 0.6).size() == 2);
  // With a high middle, the lines go around the low corners.
  for (const Line& l : isolines(high, 0.6)) {
    const Vec2d mid = (l[0] + l[1]) * 0.5;
    CHECK((mid.x - 1) * (mid.y - 1) < 0);
  }
  for (const Line& l : isolines(low, 0.6)) {
    const Vec2d mid = (l[0] + l[1]) * 0.5;
    CHECK((mid.x - 1) * (mid.y - 1) > 0);
  }
}
