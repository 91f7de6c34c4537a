// Validation of the page's requests, sums over luminaires, grids, passes and their mean.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "render/camera.h"
#include "render/measurements_csv.h"
#include "support/scenes.h"
#include "view/dimmed.h"
#include "view/dimmers.h"
#include "view/json_values.h"
#include "view/measuring_grid.h"
#include "view/passes.h"

using namespace troffer;
using namespace troffer::test;

namespace {

Scene with_lights(int count) {
  Scene s;
  const uint32_t m = add_diffuse(s, Rgb{0.5f});
  for (int i = 0; i < count; ++i) {
    const auto x = float(i);
    const uint32_t quad = add_quad(s, m, {Vec3{x, 0, 0}, {x + 1, 0, 0}, {x + 1, 1, 0}, {x, 1, 0}});
    make_light(s, quad, Rgb{float(i + 1)});
  }
  return s;
}

std::vector<std::string> all_lights(const std::vector<Dimmer>& dimmers) {
  std::vector<std::string> names;
  for (const Dimmer& d : dimmers) names.insert(names.end(), d.lights.begin(), d.lights.end());
  std::sort(names.begin(), names.end());
  return names;
}

}  // namespace

TEST_CASE("a dimmer for every name; the weakest share the last one; no light is lost") {
  const Scene few = with_lights(3);
  const auto three = dimmers_of(few, 16);
  REQUIRE(three.size() == 3);
  CHECK(three[1].name == "emitter1");
  CHECK(three[2].power > three[1].power);
  const Scene many = with_lights(20);
  const auto some = dimmers_of(many, 5);
  REQUIRE(some.size() == 5);
  CHECK(some[0].name == "emitter16");
  CHECK(some[3].name == "emitter19");
  CHECK(some[4].lights.size() == 16);
  CHECK(all_lights(some).size() == 20);
  CHECK(dimmers_of(many, 1).size() == 1);
  CHECK(all_lights(dimmers_of(many, 1)).size() == 20);
  Scene equal = with_lights(4);
  for (Light& e : equal.lights) e.name = "lamp";
  CHECK(dimmers_of(equal, 16).size() == 1);
  CHECK(dimmers_of(Scene(), 16).empty());
}

TEST_CASE("dimmer settings are read as written, and nothing else is accepted") {
  const DimmerSettings s = parse_dimmers("1,0.5,0;2,2,2", 2);
  CHECK(s[0].g == 0.5f);
  CHECK(s[1].b == 2);
  CHECK(are_all_one(parse_dimmers("", 3)));
  CHECK(!are_all_one(s));
  for (const char* bad : {"1,1", "1,1,1", "1,1,1;1,1", "1,1,1;1,1,1;1,1,1", "1,1,1;1,1,-1",
                          "1,1,1;1,1,nan", "1,1,1;1,1,inf", "1,1,1;1,1,1e9", "a", "1,1,1;1,1,1x"})
    CHECK_THROWS_AS(parse_dimmers(bad, 2), UsageError);
}

TEST_CASE("measurements of single luminaires add up, with independent errors") {
  MeasuringAnswer a;
  a.values = {{{Rgb{3}, 300, 4}}, {{Rgb{1, 0, 0}, 21.26, 3}}};
  auto m = dimmed_measurements(a, {Rgb{1}, Rgb{1}});
  CHECK(m[0].illuminance_lx == doctest::Approx(321.26));
  CHECK(m[0].standard_error == doctest::Approx(5));
  m = dimmed_measurements(a, {Rgb{0.5f}, Rgb{0}});
  CHECK(m[0].illuminance_lx == doctest::Approx(150));
  CHECK(m[0].standard_error == doctest::Approx(2));
  // Red light under a blue setting.
  m = dimmed_measurements(a, {Rgb{0}, Rgb{0, 0, 1}});
  CHECK(m[0].illuminance_lx == 0);
  a.values.resize(1);  // measured under all light
  CHECK(dimmed_measurements(a, {Rgb{0.5f}, Rgb{1}})[0].illuminance_lx == doctest::Approx(300));
  const std::string csv = measurements_csv({{{1, 2, 3}, {0, 0, 1}}}, a.values[0]);
  CHECK(csv.find("\n1,2,3,0,0,1,3,3,3,300,4\n") != csv.npos);
}

TEST_CASE("pictures of single luminaires add up; if one is missing there is none") {
  LayerBoard board;
  CHECK_THROWS_AS(dimmed_picture(board, {Rgb{1}, Rgb{1}}), UsageError);
  board.put("whole", Image(2, 1, Rgb{5}), 7, 0);
  CHECK(dimmed_picture(board, {Rgb{1}, Rgb{1}}).at(1, 0).g == 5);
  CHECK(dimmed_picture(board, {Rgb{0.5f}}).at(1, 0).g == 2.5f);
  CHECK_THROWS_AS(dimmed_picture(board, {Rgb{1}, Rgb{0}}), UsageError);
  board.put("dimmer0", Image(2, 1, Rgb{2}), 7, 0);
  board.put("dimmer1", Image(2, 1, Rgb{3}), 6, 0);
  // a layer of the previous view
  CHECK_THROWS_AS(dimmed_picture(board, {Rgb{1}, Rgb{0}}), UsageError);
  board.put("dimmer1", Image(2, 1, Rgb{3}), 7, 0);
  CHECK(dimmed_picture(board, {Rgb{1}, Rgb{0.5f, 0, 0}}).at(0, 0).r == 3.5f);
  CHECK(dimmed_picture(board, {Rgb{1}, Rgb{0.5f, 0, 0}}).at(0, 0).g == 2);
  CHECK(board.list().at("dimmer1").version > board.list().at("dimmer0").version);
}

TEST_CASE("a grid fills its rectangle with nearly square fields") {
  const MeasuringGrid g = grid_between({{0, 0, 1}, {0, 0, 1}}, {4, 2, 1.5}, {0, 0, 1}, 8);
  CHECK(g.columns == 8);
  CHECK(g.rows == 4);
  REQUIRE(g.points.size() == 32);
  CHECK(g.points[0].position.x == doctest::Approx(0.25));
  CHECK(g.points[0].position.y == doctest::Approx(0.25));
  CHECK(g.points[31].position.x == doctest::Approx(3.75));
  for (const MeasuringPoint& p : g.points) CHECK(p.position.z == doctest::Approx(1));
  // On a wall the sides are level and vertical.
  const MeasuringGrid wall = grid_between({{0, 3, 0}, {0, -1, 0}}, {2, 3, 4}, {0, 0, 1}, 4);
  CHECK(wall.points.size() == 8);
  CHECK(wall.width == doctest::Approx(2));
  CHECK(wall.depth == doctest::Approx(4));
  CHECK_THROWS_AS(grid_between({{0, 0, 0}, {0, 0, 1}}, {4, 0, 0}, {0, 0, 1}, 8), UsageError);
  CHECK_THROWS_AS(grid_between({{0, 0, 0}, {0, 0, 1}}, {4, 4, 0}, {0, 0, 1}, 500), UsageError);
  CHECK_THROWS_AS(grid_between({{0, 0, 0}, {0, 0, 1}}, {4, 4, 0}, {0, 0, 1}, 0), UsageError);
}

TEST_CASE("cameras are returned as they were sent, and mirrored worlds stay mirrored") {
  for (const float hand : {1.0f, -1.0f}) {
    Camera c = look_at({1, 2, 3}, {4, 6, 3}, {0, 0, 1}, 50);
    c.right = c.right * hand;
    c.name = "eye";
    const Vec3d origin{100, 200, 300};
    const Camera back = camera_of_json(json_of_camera(c, origin), c, origin);
    CHECK(length(back.position - c.position) < 1e-5f);
    CHECK(length(back.right - c.right) < 1e-5f);
    CHECK(length(back.up - c.up) < 1e-5f);
    CHECK(back.half_extent == doctest::Approx(c.half_extent));
  }
}

TEST_CASE("invalid cameras are refused") {
  const Camera base = look_at({0, 0, 0}, {1, 0, 0}, {0, 0, 1}, 50);
  const auto with = [&](const std::string& text) {
    return camera_of_json(parse_object(text), base, {});
  };
  const std::string rest = R"(,"up":[0,0,1],"half_extent":0.5})";
  CHECK(with(R"({"eye":[0,0,0],"forward":[2,0,0])" + rest).forward.x == 1);
  for (const std::string& bad :
       {R"({"eye":[0,0],"forward":[2,0,0])" + rest, R"({"eye":[0,0,"a"],"forward":[2,0,0])" + rest,
        R"({"eye":[0,0,1e300],"forward":[2,0,0])" + rest, R"({"forward":[2,0,0])" + rest,
        R"({"eye":[0,0,0],"forward":[0,0,0])" + rest,
        R"({"eye":[0,0,0],"forward":[3e-23,0,0])" + rest,
        R"({"eye":[0,0,0],"forward":[0,0,3])" + rest,
        std::string(R"({"eye":[0,0,0],"forward":[2,0,0],"up":[0,0,1],"half_extent":0})"),
        std::string("[1,2]"), std::string("{"), std::string(100'000, '['), std::string()})
    CHECK_THROWS_AS(with(bad), UsageError);
}

TEST_CASE("passes get finer down to the asked error; other methods take more samples") {
  const auto passes = passes_to(Method::certified, 0.01);
  CHECK(passes.front().shrink == 2);
  CHECK(passes.back().error == 0.01);
  for (size_t i = 1; i < passes.size(); ++i) {
    CHECK(passes[i].shrink == 1);
    CHECK(passes[i].error <= passes[i - 1].error);
    CHECK(passes[i].weight >= passes[i - 1].weight);
  }
  CHECK(passes_to(Method::certified, 0.3).size() == 2);
  CHECK(passes_to(Method::path, 0.01).back().spp == 256);
}

TEST_CASE("the mean of passes is weighted, and so is its error") {
  PassMean mean;
  mean.add(Image(1, 1, Rgb{9}), Image(1, 1, Rgb{1}), 1);
  mean.add(Image(2, 2, Rgb{1}), Image(2, 2, Rgb{0.3f}), 1);  // another size starts again
  mean.add(Image(2, 2, Rgb{2}), Image(2, 2, Rgb{0.1f}), 3);
  CHECK(mean.mean().at(1, 1).r == doctest::Approx(1.75));
  CHECK(mean.error().at(0, 0).r == doctest::Approx(std::sqrt(0.09 + 0.09) / 4));
  CHECK(mean.relative_error() == doctest::Approx(std::sqrt(0.18) / 4 / 1.75));
}
