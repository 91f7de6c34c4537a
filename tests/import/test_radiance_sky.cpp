// Tests of skies as gensky and gendaylit print them, and of the language of their function files.
#include <doctest/doctest.h>

#include <cmath>
#include <functional>
#include <string>

#include "base/error.h"
#include "base/units.h"
#include "import/environment_file.h"
#include "import/radiance/radiance.h"
#include "import/radiance/radiance_cal.h"
#include "scene_checks.h"
#include "temp_folder.h"

using namespace troffer;

namespace test_radiance_sky {

namespace {

Scene import_text(const std::string& text) {
  const TempFolder folder;
  return import_radiance(folder.write("scene.rad", text));
}

// The lines that the manual pages of both generators say to add to their output.
const std::string glows =
    "\nskyfunc glow sky_glow\n0\n0\n4 1 1 1 0\nsky_glow source sky\n0\n0\n4 0 0 1 180\n"
    "skyfunc glow ground_glow\n0\n0\n4 1 1 1 0\nground_glow source ground\n0\n0\n4 0 0 -1 180\n";

// Returns gendaylit's and gensky's blend of sky and ground near the horizon.
double blended(double z, double sky, double ground) {
  const double w = std::pow(z + 1.01, 10);
  return (w * sky + ground / w) / (w + 1 / w);
}

// Returns the irradiance of a horizontal surface by the hemisphere above it, given radiance by
// direction.
double irradiance(const std::function<double(const Vec3d&)>& radiance) {
  constexpr int rows = 800, columns = 800;
  double sum = 0;
  for (int i = 0; i < rows; ++i)
    for (int k = 0; k < columns; ++k) {
      const double z = (i + 0.5) / rows, phi = 2 * pi * (k + 0.5) / columns;
      const double s = std::sqrt(1 - z * z);
      sum += z * radiance({s * std::cos(phi), s * std::sin(phi), z});
    }
  return sum * 2 * pi / (double(rows) * columns);
}

// Returns the irradiance of a surface that faces a light's own axis, W/m².
double irradiance_of(const Scene& scene, size_t light) {
  const Light& e = scene.lights.at(light);
  return double(e.radiance.r) *
         double(irradiance_from_above(scene.environments.at(size_t(e.environment))).r);
}

const Vec3d to_sun{0.4, -0.6, 0.69282};

}  // namespace

TEST_CASE("gensky's skies follow the formulas of its manual page") {
  const double from_zenith = std::acos(to_sun.z);
  const auto clear = [&](const Vec3d& w) {
    const double c = dot(w, to_sun), gamma = std::acos(std::clamp(c, -1.0, 1.0));
    const double gradation = w.z > 0.01 ? 1 - std::exp(-0.32 / w.z) : 1;
    return 12 / 0.25 * (0.91 + 10 * std::exp(-3 * gamma) + 0.45 * c * c) * gradation;
  };
  const auto intermediate = [&](const Vec3d& w) {
    const double gamma = std::acos(std::clamp(dot(w, to_sun), -1.0, 1.0)), eta = std::acos(w.z);
    return 12 *
           ((1.35 * std::sin(5.631 - 3.59 * eta) + 3.12) * std::sin(4.396 - 2.6 * from_zenith) +
            6.37 - eta) /
           2.326 * std::exp(gamma * -0.563 * ((2.629 - eta) * (1.562 - from_zenith) + 0.812)) /
           0.25;
  };
  const auto overcast = [](const Vec3d& w) { return 12 * (1 + 2 * w.z) / 3; };
  struct Sky {
    std::string arguments;
    std::function<double(const Vec3d&)> radiance;
  };
  const std::string sun = " 1.200e+01 3.000e+00 2.500e-01 0.400000 -0.600000 0.692820\n";
  for (const Sky& sky : {Sky{"7 1" + sun, clear}, Sky{"7 4" + sun, intermediate},
                         Sky{"3 2 1.200e+01 3.000e+00\n", overcast},
                         Sky{"3 3 1.200e+01 3.000e+00\n", [](const Vec3d&) { return 12.0; }}}) {
    CAPTURE(sky.arguments);
    const Scene scene = import_text(
        "# gensky 6 21 12\n# Local solar time: 12.00\n\nvoid brightfunc skyfunc\n"
        "2 skybr skybright.cal\n0\n" +
        sky.arguments + glows);
    REQUIRE(scene.lights.size() == 2);
    const double expected =
        irradiance([&](const Vec3d& w) { return blended(w.z, sky.radiance(w), 3); });
    CHECK(irradiance_of(scene, 0) == doctest::Approx(expected).epsilon(0.001));
    const double from_below = irradiance([&](const Vec3d& w) {
      const Vec3d down{w.x, w.y, -w.z};
      return blended(down.z, sky.radiance(down), 3);
    });
    CHECK(irradiance_of(scene, 1) == doctest::Approx(from_below).epsilon(0.002));
    CHECK(is_near(scene.lights[0].axes[2], {0, 0, 1}));
    CHECK(is_near(scene.lights[1].axes[2], {0, 0, -1}));
    CHECK(scene.warnings.total() == 0);
  }
}

// The illuminances were integrated independently from the published definitions.
TEST_CASE("skies printed by the generators give the expected illuminance") {
  struct Known {
    const char *pattern, *reals;
    double lux;
  };
  for (const Known& k :
       {Known{"2 skybr skybright.cal", "3 2 1.2e+01 3.0e+00", 5244},
        Known{"2 skybr skybright.cal", "3 3 1.2e+01 3.0e+00", 6727},
        Known{"2 skybr skybright.cal", "7 1 1.2e+01 3.0e+00 2.5e-01 0.4 -0.6 0.692820", 23507},
        Known{"2 skybright perezlum.cal", "10 3.2 2.1 -0.97 -0.45 9.5 -3.0 0.35 0.4 -0.6 0.692820",
              2044},
        // A uniform sky of 10 over a ground of 5: 179 × 10 pi, less .2 % because the pattern blends
        // into the ground near the horizon.
        Known{"2 skybright perezlum.cal", "10 10 5 0 -1 0 -1 0 0.5 0.5 0.7071", 5611.7}}) {
    CAPTURE(k.reals);
    const Scene scene = import_text("void brightfunc skyfunc\n" + std::string(k.pattern) + "\n0\n" +
                                    k.reals + glows);
    REQUIRE(scene.lights.size() == 2);
    CHECK(179 * irradiance_of(scene, 0) == doctest::Approx(k.lux).epsilon(0.001));
  }
}

TEST_CASE("gendaylit: its sun, its sky for an impossible hour, and its coloured sky") {
  const Scene day = import_text(
      "void light solar\n0\n0\n3 6.646e+06 6.646e+06 6.646e+06\n\nsolar source sun\n0\n0\n"
      "4 0.400000 -0.600000 0.692820 0.533000\n\nvoid brightfunc skyfunc\n"
      "2 skybright perezlum.cal\n0\n"
      "10 3.2 2.1 -0.97 -0.45 9.5 -3.0 0.35 0.4 -0.6 0.692820 \n" +
      glows);
  REQUIRE(day.lights.size() == 3);
  CHECK(day.lights[0].kind == LightKind::sun);
  CHECK(day.lights[0].angular_radius == doctest::Approx(rad_from_deg(0.2665)));
  CHECK(import_text("void brightfunc skyfunc\n2 skybright perezlum.cal\n0\n"
                    "10 0.00 0.00  0.000 0.000 0.000 0.000 0.000  0.4 -0.6 -0.69 \n" +
                    glows)
            .lights.empty());
  // An overcast sky (clearness 1) has a single colour temperature, 6191 K. The coefficients make x
  // = y = 1/3, so that X, Y and Z equal the luminance. Then r, g, b are the row sums of the matrix.
  const Scene coloured = import_text(
      "void colorfunc skyfunc\n4 skybright_r skybright_g skybright_b perezlum_c.cal\n0\n"
      "22 10 0 0 -1 0 -1 0 0.5 0.5 0.7071 1 0 0 0 .33333333 0 0 0 .33333333 0 0 .33333333\n" +
      glows);
  const Rgb e = irradiance_from_above(coloured.environments.at(0));
  CHECK(e.r / e.g == doctest::Approx((2.5693 - 1.1668 - .3984) / (1.9783 - 1.0221 + .0438)));
  CHECK(e.b / e.g == doctest::Approx((1.1772 - .2519 - .0747) / (1.9783 - 1.0221 + .0438)));
}

TEST_CASE("a sky's function is evaluated, rotated, or refused by name") {
  const TempFolder folder;
  folder.write("own.cal",
               "{ brighter to the east }\nbright(d) = if(d, 1 + 3*d, 1);\neast : bright(Dx);");
  const std::string sky = " glow g 0 0 4 1 1 1 0\ng source s 0 0 4 1 0 0 180\n";  // faces east
  // E over the hemisphere around x: pi (1 + 3 · 2/3).
  const Scene own =
      import_radiance(folder.write("own.rad", "void brightfunc f 2 east own.cal 0 0\nf" + sky));
  CHECK(irradiance_of(own, 0) == doctest::Approx(3 * pi).epsilon(0.001));
  // Turned by 180 degrees, the eastern half is the dark one.
  const Scene turned = import_radiance(
      folder.write("turned.rad", "void brightfunc f 4 east own.cal -rz 180 0 0\nf" + sky));
  CHECK(irradiance_of(turned, 0) == doctest::Approx(pi).epsilon(0.001));
  folder.write("sky.rad", "void brightfunc f 2 Dx+1 . 0 0\nf glow g 0 0 4 1 1 1 0\n");
  const Scene moved = import_radiance(
      folder.write("moved.rad", "!xform -rz 90 sky.rad\ng source s 0 0 4 0 1 0 180\n"));
  CHECK(irradiance_of(moved, 0) == doctest::Approx(pi * (1 + 2.0 / 3)).epsilon(0.001));
  const auto refused = [&](const std::string& text, const char* why) {
    CAPTURE(text);
    CHECK_THROWS_WITH_AS(import_text(text), doctest::Contains(why), InputError);
  };
  refused("void brightfunc f 2 clouds mine.cal 0 0\nf" + sky, "scene.rad:1:1: the function file");
  refused("void brightfunc f 2 skybr skybright.cal 0 2 1 5\nf" + sky, "real argument 4 is missing");
  refused("void brightfunc f 2 skybr skybright.cal 0 7 1 8 5 0 0 0 1\nf" + sky, "no finite number");
  refused("void brightfunc f 2 noise3(Dx,Dy,Dz) . 0 0\nf" + sky, "random function 'noise3'");
  refused("void brightfunc f 2 a+ . 0 0\nf" + sky, "an expression ends early");
  refused("void brightfunc f 2 f(1) . 0 0\nf" + sky, "'f' is not defined");
  refused("void colorpict f 7 red green blue x.hdr . Dx Dy 0 0\nf" + sky, "--environment");
  folder.write("endless.cal", "a(x) = a(x + 1);\nb = a(1);");
  CHECK_THROWS_WITH_AS(
      import_radiance(folder.write("e.rad", "void brightfunc f 2 b endless.cal 0 0\nf" + sky)),
      doctest::Contains("does not end"), InputError);
}

// A source of full angle 2 h, seen along its axis, gives an irradiance of pi sin² h per radiance.
TEST_CASE("sources of any width") {
  for (const double angle : {70.0, 100.0, 179.0, 180.0}) {
    CAPTURE(angle);
    const Scene scene = import_text("void glow g 0 0 4 2 2 2 0\ng source s 0 0 4 0 1 1 " +
                                    std::to_string(angle) + "\n");
    REQUIRE(scene.lights.size() == 1);
    CHECK(scene.warnings.total() == 0);
    if (angle == 180) {
      CHECK(scene.lights[0].kind == LightKind::sky);
      continue;
    }
    CHECK(irradiance_of(scene, 0) ==
          doctest::Approx(2 * pi * sqr(std::sin(rad_from_deg(angle / 2)))).epsilon(0.001));
  }
  const Scene all = import_text("void glow g 0 0 4 2 2 2 0\ng source s 0 0 4 0 1 1 360\n");
  CHECK(all.lights.at(0).kind == LightKind::environment);
}

TEST_CASE("the language of function files is evaluated correctly") {
  CalProgram p;
  p.read(std::make_shared<const std::string>("x.cal"),
         "{ a { nested } comment } fact(n) : if(n - 1.5, n*fact(n - 1), 1);\n"
         "twice(f, x) = f(f(x)); add3(x) = x + 3; a = 2; sum = a + Dx;");
  const auto value = [&](const char* text) {
    const auto v = p.value(p.expression(text, {}), {{0.5, 0, 0}, {0, 0, 1}, {1, 2, 3}});
    CAPTURE(text);
    REQUIRE(v);
    return *v;
  };
  CHECK(value("1 + 2*3 - 4/8") == 6.5);
  CHECK(value("2^3^2") == 512);  // right-associative
  CHECK(value("-2^2") == 4);     // a sign binds more tightly than a power
  CHECK(value("1.5e-1 * .5") == doctest::Approx(0.075));
  CHECK(value("fact(5)") == 120);
  CHECK(value("twice(add3, 1)") == 7);
  CHECK(value("select(2, 1/0, 7, 9)") == 7);  // the others are not evaluated
  CHECK(value("if(-1, nothing, 4)") == 4);
  CHECK_FALSE(p.has_used_ray());
  CHECK(value("sum") == 2.5);
  CHECK(p.has_used_ray());
  CHECK(value("dot(P, N) + D(1)") == 3.5);
  CHECK(value("bound(0, 7, 1) + mod(7, 4) + abs(-2) + max(1, 5, 3)") == 11);
  CHECK(value("sqrt(16) + atan2(0, 1) + floor(-.5)") == 3);
  p.set_arguments({5, 6});
  CHECK(value("A2 + arg(1) + arg(0)") == 13);
  for (const char* bad : {"", "1 +", "(1", "1)", "a b", "f(", "$1", "2 3"}) {
    CAPTURE(bad);
    CHECK_THROWS_AS(p.expression(bad, {}), InputError);
  }
}

}  // namespace test_radiance_sky
