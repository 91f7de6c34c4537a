// Tests of Radiance's materials that refer to others: mixtures, mirrors with an alternate, glows
// without light, spotlights. Values follow the definitions of the reference manual.
#include <doctest/doctest.h>

#include <cmath>
#include <string>

#include "base/error.h"
#include "base/units.h"
#include "import/mesh_clean.h"
#include "import/radiance/radiance.h"
#include "scene_checks.h"
#include "temp_folder.h"

using namespace troffer;

namespace test_radiance_materials {

namespace {

Scene import_text(const std::string& text) {
  const TempFolder folder;
  return import_radiance(folder.write("scene.rad", text));
}

const std::string a_and_b =
    "void plastic a 0 0 5 .2 .2 .2 0 0\nvoid plastic b 0 0 5 .6 .6 .6 0 0\n";
const std::string square = " polygon p 0 0 12 0 0 0 1 0 0 1 1 0 0 1 0\n";

const Material& worn(const Scene& scene) {
  return scene.materials.at(scene.meshes.at(0).material);
}

}  // namespace

TEST_CASE("mixfunc blends by its function") {
  const auto mixed = [&](const std::string& function, const std::string& parts = "a b") {
    return import_text(a_and_b + "void mixfunc m 4 " + parts + " " + function + " . 0 1 .25\nm" +
                       square);
  };
  CHECK(worn(mixed("A1")).base_color.value.r == doctest::Approx(.25 * .2 + .75 * .6));
  CHECK(worn(mixed("1")).base_color.value.r == doctest::Approx(.2));
  CHECK(worn(mixed("0")).base_color.value.r == doctest::Approx(.6));
  CHECK(worn(mixed("7")).base_color.value.r == doctest::Approx(.2));  // clamped
  const Scene stripes = mixed("if(frac(Px)-.75,1,0)");                // a quarter of the surface
  CHECK(worn(stripes).base_color.value.r == doctest::Approx(.5).epsilon(0.01));
  CHECK(has_warning(stripes, "varies over the surface"));
  const Scene holes = mixed("A1", "a void");
  CHECK(worn(holes).is_alpha_blended);
  CHECK(worn(holes).alpha.value == 0.25f);
  CHECK(worn(mixed("A1", "void b")).alpha.value == 0.75f);
  const Scene noisy = mixed("'noise3(Px,Py,Pz)'");
  CHECK(has_warning(noisy, "mixture \"mixfunc\" cannot be evaluated"));
  CHECK(
      has_warning(import_text(a_and_b + "void mixpict m 7 a b grey x.hdr . Px Py 0 0\nm" + square),
                  "mixture \"mixpict\" is not supported"));
  CHECK_THROWS_AS(import_text("void mixfunc m 4 m m .5 . 0 0\nm" + square), InputError);
}

TEST_CASE("a mirror is seen as its alternate material and relays light from sources") {
  const Scene unseen = import_text("void mirror m 1 void 0 3 .1 .2 .3\nm" + square);
  CHECK(unseen.meshes.empty());
  REQUIRE(unseen.relays.size() == 1);
  CHECK(unseen.relays[0].reflectance.b == 0.3f);
  CHECK(unseen.relays[0].outline.size() == 4);
  CHECK(unseen.relays[0].normal.z == doctest::Approx(1));
  const Scene other = import_text(a_and_b + "void mirror m 1 b 0 3 .1 .1 .1\nm" + square);
  CHECK(worn(other).base_color.value.r == 0.6f);
  CHECK(other.relays.size() == 1);
  CHECK(other.warnings.entries().empty());
  const Scene plain = import_text("void mirror m 0 0 3 .1 .1 .1\nm" + square);
  CHECK(worn(plain).is_reflectance);
  CHECK(plain.relays.empty());
}

TEST_CASE("shapes of mirrors with an alternate material") {
  const std::string mirror = "void mirror m 1 void 0 3 .1 .1 .1\n";
  // An L of three squares: its relays together have its area.
  const Scene concave =
      import_text(mirror + "m polygon p 0 0 18  0 0 1  2 0 1  2 1 1  1 1 1  1 2 1  0 2 1\n");
  double area = 0;
  for (const LightRelay& r : concave.relays) {
    CHECK(r.normal.z == doctest::Approx(1));
    Vec3 twice;
    for (size_t i = 2; i < r.outline.size(); ++i)
      twice = twice + cross(r.outline[i - 1] - r.outline[0], r.outline[i] - r.outline[0]);
    area += double(twice.z) / 2;
  }
  CHECK(area == doctest::Approx(3));
  const Scene ring = import_text(mirror + "m ring r 0 0 8  1 2 3  0 0 -1  0 2\n");
  REQUIRE(ring.relays.size() == 1);
  CHECK(ring.relays[0].normal.z == doctest::Approx(-1));
  CHECK(length(Vec3d(ring.relays[0].outline[5]) + ring.origin - Vec3d{1, 2, 3}) ==
        doctest::Approx(2));
  CHECK(has_warning(import_text(mirror + "m ring r 0 0 8  0 0 0  0 0 1  1 2\n"), "hole"));
  CHECK(import_text(mirror + "m sphere s 0 0 4  0 0 0  1\n").relays.empty());
}

TEST_CASE("a glow with a negative radius gives no light") {
  CHECK(import_text("void glow g 0 0 4 5 5 5 -1\ng" + square).lights.empty());
  for (const char* radius : {"0", "2"})
    CHECK(import_text("void glow g 0 0 4 5 5 5 " + std::string(radius) + "\ng" + square)
              .lights.size() == 1);
}

TEST_CASE("constant patterns are factors") {
  const std::string dim = "void brightfunc d 2 A1 . 0 1 .5\n";
  CHECK(worn(import_text(dim + "d plastic m 0 0 5 .8 .8 .8 0 0\nm" + square)).base_color.value.r ==
        doctest::Approx(.4));
  const Scene lamp = import_text(dim +
                                 "void colorfunc c 4 1 2 3 . 0 0\nd alias e c\n"
                                 "c light m 0 0 3 10 10 10\nm" +
                                 square);
  CHECK(lamp.lights.at(0).radiance == Rgb{10, 20, 30});
  const Scene varied =
      import_text("void brightfunc d 2 Px . 0 0\nd light m 0 0 3 10 10 10\nm" + square);
  CHECK(varied.lights.at(0).radiance == Rgb{10});
  CHECK(has_warning(varied, "varies over the surface"));
}

// E = L A cos / (d + f)², where f is the length of the aiming vector.
TEST_CASE("spotlight: focal distance and beam are correct on any surface") {
  const auto spot = [](const std::string& aim, const std::string& surface) {
    return import_text("void spotlight s 0 0 7 1000 1000 1000 30 " + aim + "\ns " + surface);
  };
  const std::string polygon =
      "polygon p 0 0 12 .1 .1 3 .1 -.1 3 -.1 -.1 3 -.1 .1 3\n";  // looks down
  const std::string ring = "ring r 0 0 8 0 0 3 0 0 -1 0 .2\n";
  for (const double f : {0.1, 1.0, 3.0})
    for (const bool is_ring : {false, true}) {
      CAPTURE(f);
      const Scene scene = spot("0 0 -" + std::to_string(f), is_ring ? ring : polygon);
      REQUIRE(scene.lights.size() == 1);
      const Light& e = scene.lights[0];
      CHECK(is_near(e.position, {0, 0, 3}));
      CHECK(e.radiance.r == doctest::Approx(1000 * (is_ring ? pi * .04 : .04)));
      CHECK(double(e.focal_distance) == doctest::Approx(f));
      const LightWeb& web = scene.webs.at(size_t(e.web));
      // The cosine up to 15 degrees, and zero beyond.
      CHECK(double(web.vertical_angles_rad.back()) == doctest::Approx(rad_from_deg(15)));
      for (size_t i = 0; i < web.vertical_angles_rad.size(); ++i)
        CHECK(web.intensities[i] == doctest::Approx(std::cos(web.vertical_angles_rad[i])));
    }
  CHECK(spot("0 0 1", ring).lights.empty());  // into the surface
  const Scene ball = spot("0 0 -1", "sphere b 0 0 4 0 0 3 .2\n");
  CHECK(ball.lights.at(0).radiance.r == doctest::Approx(1000 * pi * .04));
  const Scene tube = spot("0 0 -1", "cylinder b 0 0 7 -1 0 3 1 0 3 .2\n");
  CHECK(tube.lights.at(0).radiance.r == doctest::Approx(1000 * 2 * .4));
}

TEST_CASE("materials by functions keep their diffuse parts") {
  Material m =
      worn(import_text("void transdata t 4 noop d.dat . Dx 0 6 .9 .9 .9 .1 .5 1\nt" + square));
  CHECK(m.base_color.value.r == doctest::Approx(.9 * (1 - .9 * .5)));
  CHECK(m.diffuse_transmission_color.value.r == doctest::Approx(.9 * .9 * .5));
  const Scene diffuse = import_text(
      "void BRTDfunc t 10 0 0 0 0 0 0 0 0 0 . 0 9 .3 .3 .3 .3 .3 .3 .2 .2 .2\nt" + square);
  CHECK(worn(diffuse).base_color.value.r == 0.3f);
  CHECK(worn(diffuse).diffuse_transmission_color.value.r == 0.2f);
  CHECK(diffuse.warnings.total() == 0);
  CHECK_THROWS_AS(import_text("void transfunc t 2 1 . 0 5 .9 .9 .9 .1 .5\nt" + square), InputError);
}

TEST_CASE("files and fronts: cat and xform of several, quotes, -I") {
  const TempFolder folder;
  folder.write("m.mat", a_and_b);
  folder.write("p.rad", "a" + square);
  folder.write("lamp.rad", "void light l 0 0 3 1 1 1\nl" + square);
  CHECK(import_radiance(folder.write("s.rad", "!xform -t 0 0 1 m.mat p.rad\n")).meshes.size() == 1);
  CHECK(triangle_count(import_radiance(
            folder.write("s.rad", "!cat m.mat p.rad | xform -a 2 -t 2 0 0\n"))) == 4);
  CHECK(import_radiance(folder.write("s.rad",
                                     "void brightfunc b 2 '1 + 0*(2 - 3)' \".\" 0 0\n"
                                     "b plastic m 0 0 5 .5 .5 .5 0 0\nm" +
                                         square))
            .warnings.total() == 0);
  for (const bool is_inverted : {false, true})
    for (const bool is_mirrored : {false, true}) {
      const Scene s =
          import_radiance(folder.write("s.rad", std::string("!xform") + (is_inverted ? " -I" : "") +
                                                    (is_mirrored ? " -mz" : "") + " lamp.rad\n"));
      const Mesh& mesh = s.meshes.at(0);
      CHECK((area_vector(mesh, mesh.triangles.at(0)).z > 0) == (is_inverted == is_mirrored));
    }
}

}  // namespace test_radiance_materials
