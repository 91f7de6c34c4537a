// Whole assessments compared with closed forms, with `path`, and with the sum of their parts.
#include <doctest/doctest.h>

#include <cmath>

#include "base/error.h"
#include "base/units.h"
#include "light/irradiance.h"
#include "report/assessment.h"
#include "report/checks.h"
#include "report/report.h"
#include "room.h"
#include "support/quadrature.h"

using namespace troffer;
using namespace troffer::test;

namespace {

const StopFlag never_stop = false;

AssessmentOptions options_of(int spp) {
  AssessmentOptions o;
  o.measure.spp = spp;
  o.measure.threads = 2;
  o.maintenance = 1;
  return o;
}

// A black room, so that all light is direct.
Scene black_room_with_panel() {
  Scene s;
  s.is_photometric = true;
  const uint32_t black = add_diffuse(s, Rgb{0});
  for (const uint32_t m : add_box_inside(s, black, {-2, -2.5f, 0}, {2, 2.5f, 3}))
    s.meshes[m].name = m == 0 ? "floor" : "wall";
  add_panel(s, "panel", 0, 0, 1.2f, 2.95f, Rgb{4000});
  return s;
}

Scene bulb_over_floor() {
  Scene s;
  s.is_photometric = true;
  const uint32_t black = add_diffuse(s, Rgb{0});
  add_quad(s, black, {Vec3{-3, -3, 0}, {3, -3, 0}, {3, 3, 0}, {-3, 3, 0}});
  Light e;
  e.kind = LightKind::point;
  e.name = "bulb";
  e.position = {0, 0, 3};
  e.radiance = Rgb{900};
  s.lights.push_back(e);
  return s;
}

}  // namespace

TEST_CASE("a panel over a work plane: each point and the mean against Lambert's formula") {
  const Scene scene = black_room_with_panel();
  AssessmentOptions o = options_of(256);
  o.maintenance = 0.8;
  o.has_cylindrical = false;
  const Assessment a = assess(scene, o, {}, never_stop);
  REQUIRE(a.surfaces.size() == 1);
  const SurfaceResult& s = a.surfaces[0];
  CHECK(s.surface.kind == SurfaceKind::work_plane);
  const std::vector<Vec3d> panel{
      {-0.6, -0.6, 2.95}, {-0.6, 0.6, 2.95}, {0.6, 0.6, 2.95}, {0.6, -0.6, 2.95}};
  const auto exact = [&](double x, double y) {
    return 0.8 * 4000 * polygon_irradiance(panel, {x, y, 0.75}, {0, 0, 1});
  };
  double sum = 0;
  for (size_t i = 0; i < s.grid.points.size(); ++i) {
    const Vec3d& p = s.grid.points[i].position;
    CHECK(std::abs(s.electric[i].value - exact(p.x, p.y)) <
          5 * s.electric[i].error + 2e-3 * exact(p.x, p.y));
    sum += exact(p.x, p.y);
  }
  const GridSummary g = summary_of(s.electric);
  CHECK(g.mean.value == doctest::Approx(sum / double(s.grid.points.size())).epsilon(2e-3));
  // The grid's mean approximates that of the area without its border, by quadrature, within a few
  // percent.
  const double mean = integrate_2d<double>(exact, -1.5, 1.5, -2, 2, 24) / 12;
  CHECK(g.mean.value == doctest::Approx(mean).epsilon(0.02));
  REQUIRE(!a.checks.empty());
  CHECK(a.checks[0].quantity == "Ēm");
  CHECK(a.checks[0].required == 500);
  CHECK(a.power.floor_area == doctest::Approx(20));
  CHECK_FALSE(a.power.watts.has_value());
  CHECK(a.power.lumens == doctest::Approx(4000 * pi * 1.44).epsilon(1e-4));
}

TEST_CASE("a point source: cylindrical illuminance is I sin(a) / (pi d²), and its modelling") {
  const Scene scene = bulb_over_floor();
  AssessmentOptions o = options_of(64);
  o.has_contributions = false;
  const Assessment a = assess(scene, o, {}, never_stop);
  REQUIRE(a.cylinders.size() == 12);
  for (const CylinderResult& c : a.cylinders) {
    const Vec3d way = Vec3d{0, 0, 3} - c.position;
    const double d2 = dot(way, way), sine = std::hypot(way.x, way.y) / std::sqrt(d2);
    CHECK(c.position.z == doctest::Approx(1.2));
    CHECK(c.cylindrical.value == doctest::Approx(900 * sine / (pi * d2)).epsilon(0.0065));
    CHECK(c.horizontal.value == doctest::Approx(900 * way.z / std::pow(d2, 1.5)).epsilon(1e-3));
  }
}

TEST_CASE("the report of an office: single luminaires add up to the total, with one watt each") {
  const Scene scene = small_office();
  AssessmentOptions o = options_of(256);
  o.power = {{"*", 20}, {"left", 40}};
  const Assessment a = assess(scene, o, {}, never_stop);
  REQUIRE(a.surfaces.size() == 2);
  REQUIRE(a.groups.size() == 2);
  CHECK(a.groups[0].watts == 40);
  CHECK(a.power.watts == 60);
  for (const SurfaceResult& s : a.surfaces) {
    const Figure mean = mean_of(s.electric);
    const Figure parts = sum(s.by_group[0], s.by_group[1]);
    CHECK(std::abs(parts.value - mean.value) < 4 * std::hypot(parts.error, mean.error));
    CHECK(parts.value == doctest::Approx(mean.value).epsilon(0.02));
    CHECK(s.by_group[0].value > 1.5 * s.by_group[1].value);
  }
  // Points under the keyboard and floor points under the cabinet are left out.
  CHECK(a.surfaces[0].grid.points.size() < 50);
  for (const GridPoint& p : a.surfaces[0].grid.points)
    CHECK_FALSE(
        (p.position.x > 1.2 && p.position.x < 1.6 && p.position.y > 1.6 && p.position.y < 1.9));
  CHECK(a.notes.size() == 2);
  for (const GridPoint& p : a.surfaces[1].grid.points)
    CHECK_FALSE((p.position.x > 2.9 && p.position.y < 1.7));
  CHECK(worst_glare(a, 0) != nullptr);
  CHECK(worst_glare(a, 1) != nullptr);
  CHECK(a.checks.size() >= 5);
  const std::string page = report_page({{"t", "", "s", "1", "c", {}, {}, {}}, o, a, {}, {}});
  CHECK(page.find("W/m² per 100 lx") != std::string::npos);
}

TEST_CASE("figures of the default method agree with path tracing") {
  const Scene scene = small_office();
  AssessmentOptions o = options_of(512), by_paths = options_of(4096);
  o.has_contributions = by_paths.has_contributions = false;
  by_paths.measure.method = Method::path;
  const Assessment a = assess(scene, o, {}, never_stop),
                   b = assess(scene, by_paths, {}, never_stop);
  const auto agree = [](const Figure& x, const Figure& y, double slack) {
    CHECK(std::abs(x.value - y.value) < 4 * std::hypot(x.error, y.error) + slack * y.value);
  };
  for (size_t i = 0; i < a.surfaces.size(); ++i) {
    const GridSummary s = summary_of(a.surfaces[i].electric),
                      t = summary_of(b.surfaces[i].electric);
    agree(s.mean, t.mean, 0.005);
    agree(s.least, t.least, 0.01);
  }
  REQUIRE(a.glares.size() == b.glares.size());
  for (size_t i = 0; i < a.glares.size(); ++i) {
    CHECK(a.glares[i].glare.is_defined == b.glares[i].glare.is_defined);
    if (a.glares[i].glare.is_defined) agree(a.glares[i].glare.ugr, b.glares[i].glare.ugr, 0.005);
  }
  for (size_t i = 0; i < a.cylinders.size(); ++i)
    agree(a.cylinders[i].cylindrical, b.cylinders[i].cylindrical, 0.01);
}

TEST_CASE("UGR rises by 8 log10 k with k times the light and does not depend on maintenance") {
  AssessmentOptions o = options_of(128);
  o.has_contributions = o.has_cylindrical = false;
  Scene bright = small_office();
  for (Light& e : bright.lights) e.radiance *= 10;
  const Assessment a = assess(small_office(), o, {}, never_stop);
  o.maintenance = 0.5;
  const Assessment b = assess(bright, o, {}, never_stop);
  for (size_t i = 0; i < a.glares.size(); ++i)
    if (a.glares[i].glare.is_defined)
      CHECK(b.glares[i].glare.ugr.value - a.glares[i].glare.ugr.value ==
            doctest::Approx(8).epsilon(0.02));
  CHECK(mean_of(b.surfaces[0].electric).value ==
        doctest::Approx(5 * mean_of(a.surfaces[0].electric).value).epsilon(0.01));
}

TEST_CASE("daylight and electric light are separated, whatever their names") {
  Scene s = small_office();
  s.lights[0].name = "sun";
  Light e;
  e.kind = LightKind::distant;
  e.name = "sun";
  e.direction = {0, 0, -1};
  e.radiance = Rgb{1000};
  s.lights.push_back(e);
  const PreparedScene prepared(with_daylight_apart(s));
  const auto [day, lamps] = daylight_and_luminaires(prepared.scene);
  CHECK(day == std::vector<std::string>{"sun (daylight)"});
  CHECK(lamps == std::vector<std::string>{"sun", "right"});
}

TEST_CASE("many luminaires are reported in groups") {
  Scene s = small_office();
  for (int i = 0; i < 20; ++i)
    add_panel(s, "spot." + std::to_string(100 + i), 0.1f * float(i), 1, 0.05f, 2.7f, Rgb{100});
  const auto groups = light_groups(s, {{"spot*", 5}}, 12);
  REQUIRE(groups.size() == 3);
  CHECK(groups[2].name == "spot");
  CHECK(groups[2].luminaires == 20);
  CHECK(groups[2].watts == 100);
  CHECK_FALSE(groups[0].watts.has_value());
  CHECK(light_groups(s, {}, 2).size() == 3);  // the strongest two, and "others"
  CHECK(light_groups(s, {}, 2)[2].name == "others");
  CHECK_THROWS_AS(light_groups(s, {{"nobody", 5}}, 12), UsageError);
}

TEST_CASE("within two standard errors a requirement is undecided") {
  CHECK(verdict_of({510, 2}, 500, false) == Verdict::pass);
  CHECK(verdict_of({503, 2}, 500, false) == Verdict::open);
  CHECK(verdict_of({497, 2}, 500, false) == Verdict::open);
  CHECK(verdict_of({490, 2}, 500, false) == Verdict::fail);
  CHECK(verdict_of({18.5, 0.1}, 19, true) == Verdict::pass);
  CHECK(verdict_of({19.5, 0.1}, 19, true) == Verdict::fail);
  CHECK(verdict_of({500, 0}, 500, false) == Verdict::pass);
}

TEST_CASE("observers on the floor are rated by the task's UGR limit") {
  AssessmentOptions o = options_of(64);
  o.has_contributions = o.has_cylindrical = false;
  Scene bright = small_office();
  for (Light& e : bright.lights) e.radiance *= 10;
  const Assessment a = assess(bright, o, {}, never_stop);
  REQUIRE(a.surfaces[1].surface.kind == SurfaceKind::floor);
  const Glare* worst = worst_glare(a, 1);
  REQUIRE(worst != nullptr);
  REQUIRE(worst->ugr.value > 19);
  size_t judged = 0;
  for (const Check& c : a.checks) {
    if (c.subject != a.surfaces[1].surface.name || c.quantity != "UGR") continue;
    ++judged;
    CHECK(c.required == 19);
    CHECK(c.verdict == Verdict::fail);
    CHECK(c.profile == "office-writing");
  }
  CHECK(judged == 1);
  // A profile without limits yields no check.
  o.surfaces = {{"floor", "none", "", 0, 0, {}, {}, {}}};
  for (const Check& c : assess(bright, o, {}, never_stop).checks) CHECK(c.quantity != "UGR");
}

TEST_CASE("an undecided check states how many samples would decide it") {
  // The value's distance is half of two standard errors: four times as many samples decide.
  const Check c{"desk", "p", "Ēm", "lx", 500, false, {503, 3}, verdict_of({503, 3}, 500, false)};
  CHECK(samples_to_decide(c, 1024).value() == doctest::Approx(4096));
  const Check sure{"desk", "p", "Ēm", "lx", 500, false, {520, 3}, Verdict::pass};
  CHECK_FALSE(samples_to_decide(sure, 1024).has_value());
  const Check equal{"desk", "p", "Ēm", "lx", 500, false, {500, 3}, Verdict::open};
  CHECK_FALSE(samples_to_decide(equal, 1024).has_value());
}

TEST_CASE("a stop ends an assessment, and too many points are refused") {
  const StopFlag stopped = true;
  CHECK_FALSE(assess(small_office(), options_of(64), {}, stopped).is_complete);
  AssessmentOptions o = options_of(64);
  o.surfaces = {{"", "none", "x", 0, 0, {}, {1e5, 0, 0}, {0, 0.1, 0}}};
  CHECK_THROWS_AS(assess(small_office(), o, {}, never_stop), UsageError);
  o.surfaces[0].profile = "nobody";
  CHECK_THROWS_AS(assess(small_office(), o, {}, never_stop), UsageError);
}
