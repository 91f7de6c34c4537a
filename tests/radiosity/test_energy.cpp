// Energy: solutions terminate, and balances close or report that they do not.
#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "radiosity/closure.h"
#include "radiosity/rooms.h"

using namespace troffer;
using namespace troffer::test;

namespace {

// Returns five walls and two boxes, bottoms included, that stand `gap` above the floor, with a
// light under the ceiling: 36 triangles.
Scene cornell_box(float rho, float gap) {
  Scene s;
  const uint32_t white = add_diffuse(s, Rgb{rho});
  const auto walls = add_box_inside(s, white, {0, 0, 0}, {5.5f, 5.5f, 5.5f});
  s.meshes[walls[2]].triangles.clear();  // open at the front
  const auto box = [&](const Vec3& a, const Vec3& b) {
    for (const uint32_t q : add_box_inside(s, white, a, b))
      std::swap(s.meshes[q].positions[1], s.meshes[q].positions[3]);
  };
  box({1, 1, gap}, {2.6f, 2.4f, 1.65f});
  box({3, 3, gap}, {4.6f, 4.6f, 3.3f});
  const uint32_t q =
      add_quad(s, add_diffuse(s, Rgb{0.5f}),
               {Vec3{2, 2, 5.45f}, {2, 3.3f, 5.45f}, {3.3f, 3.3f, 5.45f}, {3.3f, 2, 5.45f}});
  make_light(s, q, Rgb{1});
  return s;
}

void check_invariant(const RadiositySolution& s) {
  const EnergyBalance& b = s.balance;
  CHECK(b.absorbed + b.lost_to_specular + b.unshot + b.escaped + b.unaccounted ==
        doctest::Approx(b.emitted).epsilon(1e-4));
  for (const double part : {b.absorbed, b.lost_to_specular, b.unshot, b.escaped}) CHECK(part >= 0);
  CHECK(b.absorbed <= b.emitted * 1.0001);
  CHECK(std::abs(b.unaccounted) < 0.05 * b.emitted);
  if (std::abs(b.unaccounted) > 0.01 * b.emitted) CHECK(!radiosity_warnings(s).empty());
  for (uint32_t i = 0; i < s.mesh.points.size(); ++i) CHECK(is_finite(s.irradiance(i)));
}

RadiosityOptions coarse() {
  RadiosityOptions o;
  o.meshing = sizes(1.4f, 2.8f);
  return o;
}

double indirect_power(const RadiositySolution& s) {
  double sum = 0;
  for (uint32_t i = 0; i < s.mesh.points.size(); ++i) {
    Rgb light = s.general[i] - s.general_direct[i];
    for (const StoredContribution& c : s.contributions(i))
      if (c.source != no_source && !s.is_light(c.source)) light += c.received;
    sum += double(luminance(light) * s.mesh.points[i].area);
  }
  return sum;
}

}  // namespace

TEST_CASE("white boxes on a white floor: unshot power decreases with every shot") {
  for (const float gap : {0.0f, 1e-6f, 1e-4f}) {
    const Ready ready(cornell_box(1, gap));
    const StopFlag never = false;
    RadiosityOptions o = coarse();
    o.unshot_fraction = 0.03f;
    double unshot = 2;
    bool falls = true;
    const RadiositySolution s = solve_radiosity(
        ready.scene, ready.tracer, ready.tables, ready.lights, o, 2,
        [&](const RadiosityProgress& p) {
          falls = falls && p.unshot <= unshot * 1.000001;
          unshot = p.unshot;
        },
        never);
    CHECK(falls);
    CHECK(s.is_complete);
    check_invariant(s);
    MESSAGE("gap " << gap << ": " << s.shots << " shots; absorbed " << s.balance.absorbed
                   << ", escaped " << s.balance.escaped << ", unaccounted " << s.balance.unaccounted
                   << " of " << s.balance.emitted);
  }
}

TEST_CASE("a perfectly white closed room: effort is bounded, with a warning") {
  Scene scene;
  const auto quads = add_box_inside(scene, add_diffuse(scene, Rgb{1}), {0, 0, 0}, {4, 3, 2.5f});
  make_light(scene, quads[1], Rgb{3});
  const Ready ready(std::move(scene));
  RadiosityOptions o = coarse();
  o.max_shots = 500;
  const RadiositySolution s = ready.solve(o);
  CHECK(s.end == RadiosityEnd::out_of_shots);
  CHECK_FALSE(s.is_complete);
  CHECK(s.shots == 500);
  CHECK(s.balance.escaped == 0);
  check_invariant(s);
  REQUIRE(radiosity_warnings(s).size() == 1);
  CHECK(radiosity_warnings(s)[0].find("500 shots") != std::string::npos);
  o.max_million_rays = 0;
  CHECK(ready.solve(o).end == RadiosityEnd::out_of_rays);
}

TEST_CASE("where most light escapes, the rest is still reflected correctly") {
  Scene scene;  // two sheets that share an edge; the light shines up and sideways
  const uint32_t grey = add_diffuse(scene, Rgb{0.7f});
  add_quad(scene, grey, {Vec3{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}});
  add_quad(scene, grey, {Vec3{0, 0, 0}, {0, 2, 0}, {0, 2, 2}, {0, 0, 2}});
  const uint32_t q = add_quad(scene, add_diffuse(scene, Rgb{0}),
                              {Vec3{6, 0, 1}, {6.8f, 0, 1}, {6.8f, 1, 1.4f}, {6, 1, 1.4f}});
  make_light(scene, q, Rgb{10}, true);
  const Ready ready(std::move(scene));
  RadiosityOptions o;
  o.meshing = sizes(0.25f, 0.8f);
  const RadiositySolution s = ready.solve(o);
  o.unshot_fraction = 1e-4f;
  const RadiositySolution fine = ready.solve(o);
  CHECK(s.balance.escaped > 0.9 * s.balance.emitted);
  check_invariant(s);
  CHECK(radiosity_warnings(s).empty());
  MESSAGE("indirect " << indirect_power(s) / indirect_power(fine) << " of what it is in the end");
  CHECK(indirect_power(s) > 0.95 * indirect_power(fine));
}

TEST_CASE("lost light causes a warning") {
  // A light so close to its shade that no sample point of the coarse elements sees it.
  Scene scene;
  const uint32_t grey = add_diffuse(scene, Rgb{0.5f});
  add_box_inside(scene, grey, {0, 0, 0}, {4, 4, 4});
  const uint32_t q = add_quad(
      scene, add_diffuse(scene, Rgb{0}),
      {Vec3{2, 2, 3.999f}, {2.05f, 2, 3.999f}, {2.05f, 2.05f, 3.999f}, {2, 2.05f, 3.999f}});
  make_light(scene, q, Rgb{10});  // it faces the ceiling, a millimetre away
  const Ready ready(std::move(scene));
  RadiosityOptions o;
  o.meshing = sizes(1, 2);
  const RadiositySolution s = ready.solve(o);
  CHECK(s.balance.unaccounted > 0.5 * s.balance.emitted);
  REQUIRE(radiosity_warnings(s).size() == 1);
  CHECK(radiosity_warnings(s)[0].find("% of the emitted power reached no sample point") !=
        std::string::npos);
}

TEST_CASE("a scene without light has a solution at once") {
  Scene scene;
  add_box_inside(scene, add_diffuse(scene, Rgb{0.5f}), {0, 0, 0}, {4, 4, 4});
  const Ready ready(std::move(scene));
  const RadiositySolution s = ready.solve();
  CHECK(s.is_complete);
  CHECK(s.shots == 0);
  CHECK(s.rays == 0);
  CHECK(radiosity_warnings(s).empty());
}

TEST_CASE("the energy balance of a shot is closed") {
  const OpenShare closed{0, 0};
  const std::vector<float> even(100, 1.0f);
  SUBCASE("a small error is corrected everywhere alike") {
    const Closure c = close_shot(even, 100, 97, closed);
    CHECK(c.of(1.0f) == doctest::Approx(0.97f));
    CHECK(close_shot(even, 100, 104, closed).arrived == doctest::Approx(104));
  }
  SUBCASE("a larger error stays missing") {
    CHECK(close_shot(even, 100, 200, closed).arrived == doctest::Approx(130));
  }
  SUBCASE("an excess is taken from the receivers that got most") {
    std::vector<float> powers = even;
    powers[7] = 100;
    const Closure c = close_shot(powers, 199, 110, closed);
    CHECK(c.arrived == doctest::Approx(110));
    CHECK(c.of(1.0f) == doctest::Approx(1).epsilon(1e-4));
    CHECK(c.of(100.0f) == doctest::Approx(11).epsilon(1e-3));
  }
  SUBCASE("light known to leave the scene is excluded") {
    const OpenShare half{0.5, 0.1};
    CHECK(close_shot(even, 100, 200, half).scale == doctest::Approx(1));
    CHECK(close_shot(even, 100, 150, half).arrived == doctest::Approx(90));
    CHECK(close_shot(even, 100, 400, half).arrived == doctest::Approx(130));
    CHECK(close_shot(even, 100, 170, half).arrived == doctest::Approx(100));
    CHECK(open_share(0, 8, false).error > 0.2);
    CHECK(open_share(0.2, 1000, false).share == 0.2);
    CHECK(open_share(0.2, 1000, true).share == 0);
  }
  SUBCASE("receivers never get more than was sent") {
    std::vector<float> powers = {1e30f, 1e-30f, 3, 0};
    double sum = 0;
    for (const float p : powers) sum += double(p);
    const Closure c = close_shot(powers, sum, 5, closed);
    double counted = 0;
    for (const float p : powers) counted += double(c.of(p));
    CHECK(counted <= 5.001);
    CHECK(c.of(std::numeric_limits<float>::quiet_NaN()) == 0);
  }
}
