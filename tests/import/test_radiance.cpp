// Tests of Radiance's scene files: syntax, surfaces and their fronts, materials, commands, views.
#include "import/radiance/radiance.h"

#include <doctest/doctest.h>

#include <cmath>
#include <string>

#include "base/error.h"
#include "base/units.h"
#include "import/import.h"
#include "import/mesh_clean.h"
#include "mutations.h"
#include "scene_checks.h"
#include "temp_folder.h"

using namespace troffer;

namespace test_radiance {

namespace {

Scene import_text(const std::string& text) {
  const TempFolder folder;
  return import_radiance(folder.write("scene.rad", text));
}

std::string error_of(const std::string& text) {
  try {
    import_text(text);
  } catch (const InputError& e) {
    const std::string what = e.what();
    return what.substr(what.find("scene.rad"));
  }
  return "";
}

const std::string grey = "void plastic grey 0 0 5 .5 .5 .5 0 0\n";
const std::string bright = "void light bright 0 0 3 10 20 30\n";

// Returns the area and, for closed surfaces, the enclosed volume.
std::pair<double, double> area_and_volume(const Scene& scene) {
  double area = 0, volume = 0;
  for (const Mesh& m : scene.meshes)
    for (const Triangle& t : m.triangles) {
      const Vec3d n = area_vector(m, t);
      area += length(n) / 2;
      volume += dot(n, Vec3d(m.positions[t[0]])) / 6;
    }
  return {area, volume};
}

}  // namespace

TEST_CASE("polygons emit to the side from which they run counterclockwise") {
  const Scene scene = import_text("# a comment\n" + bright +
                                  "bright polygon top\n0\n0\n9 0 0 3  0 1 3  1 0 3  # down\n");
  REQUIRE(scene.lights.size() == 1);
  const Light& e = scene.lights[0];
  CHECK(e.name == "top");
  CHECK(e.radiance == Rgb{10, 20, 30});
  CHECK_FALSE(e.is_two_sided);
  CHECK_FALSE(scene.is_photometric);
  const Mesh& m = scene.meshes.at(e.geometry);
  CHECK(area_vector(m, m.triangles.at(0)).z < 0);
  CHECK(scene.materials.at(m.material).base_color.value == Rgb{0});
}

TEST_CASE("closed surfaces have their fronts outside, their counterparts inside") {
  const auto [cone_area, cone] =
      area_and_volume(import_text(grey + "grey cone c 0 0 8 0 0 0 0 0 3 1 0"));
  CHECK(cone_area == doctest::Approx(pi * std::sqrt(10)).epsilon(0.01));
  CHECK(cone == doctest::Approx(pi).epsilon(0.01));
  CHECK(area_and_volume(import_text(grey + "grey cup c 0 0 8 0 0 0 0 0 3 1 0")).second < 0);
  const auto [tube_area, tube] =
      area_and_volume(import_text(grey + "grey tube c 0 0 7 1 1 1 1 4 1 .5"));
  CHECK(tube_area == doctest::Approx(pi * 3).epsilon(0.01));
  CHECK(tube < 0);
  const Scene balls =
      import_text(grey + "grey sphere s 0 0 4 1 2 3 2\ngrey bubble b 0 0 4 0 0 0 1");
  REQUIRE(balls.spheres.size() == 2);
  CHECK_FALSE(balls.spheres[0].is_inside_out);
  CHECK(balls.spheres[1].is_inside_out);
  CHECK(balls.spheres[0].radius == 2);
  const Scene rings = import_text(grey + "grey ring r 0 0 8 1 2 3 0 0 -2 0 1.5\n" +
                                  "grey ring q 0 0 8 0 0 0 0 1 0 1 2");
  REQUIRE(rings.disks.size() == 1);
  CHECK(is_near(rings.disks[0].normal, {0, 0, -1}));
  CHECK(rings.disks[0].radius == 1.5f);
  CHECK(area_and_volume(rings).first == doctest::Approx(3 * pi).epsilon(0.01));
  CHECK(area_vector(rings.meshes[0], rings.meshes[0].triangles[0]).y > 0);
}

TEST_CASE("xform: order, arrays, mirroring and pipes") {
  const TempFolder folder;
  folder.write("sub/ball.rad", grey + "grey sphere s 0 0 4 1 0 0 .25\n");
  const Scene scene = import_radiance(
      folder.write("scene.rad",
                   "!xform -t 1 0 0 -rz 90 sub/ball.rad\n!xform -a 3 -t 0 0 2 -a 2 -t 0 5 0 \\\n "
                   "sub/ball.rad\n!cat sub/ball.rad | xform -s 2 | xform -t 0 0 1\n"));
  REQUIRE(scene.spheres.size() == 8);
  CHECK(is_near(scene.spheres[0].centre, {0, 2, 0}));
  CHECK(is_near(scene.spheres[1].centre, {1, 0, 0}));
  CHECK(is_near(scene.spheres[6].centre, {1, 5, 4}));
  CHECK(is_near(scene.spheres[7].centre, {2, 0, 1}));
  CHECK(scene.spheres[7].radius == 0.5f);
  for (const char* option : {"", " | xform -mx", " | xform -my -rx 30 -i 2 -ry 10"}) {
    CAPTURE(option);
    const auto [area, volume] =
        area_and_volume(import_text(grey + "!genbox grey box 1 2 3" + option));
    CHECK(area == doctest::Approx(22));
    CHECK(volume == doctest::Approx(6));
  }
  CHECK(area_and_volume(import_text(grey + "!genbox grey box 1 2 3 -i")).second ==
        doctest::Approx(-6));
}

TEST_CASE("commands are never run") {
  const TempFolder folder;
  const std::string trace = folder.path("trace");
  const Scene scene = import_radiance(folder.write(
      "scene.rad",
      grey + "!touch " + trace + "\n!genbox grey b 1 1 1 | tee " + trace + "\n!gensky 6 21 12\n"));
  CHECK_FALSE(std::filesystem::exists(trace));
  CHECK(has_warning(scene, "\"!touch\" is not run"));
  CHECK(has_warning(scene, "\"!tee\" is not run"));
  CHECK(has_warning(scene, "\"!gensky\" is not run"));
}

TEST_CASE("Radiance's materials") {
  const auto material = [](const std::string& text) {
    const Scene scene = import_text(text + "\nm sphere s 0 0 4 0 0 0 1");
    REQUIRE(scene.spheres.size() == 1);
    return scene.materials.at(scene.spheres[0].material);
  };
  Material m = material("void plastic m 0 0 5 .1 .2 .3 0 0");
  CHECK(m.kind == MaterialKind::diffuse);
  CHECK(m.base_color.value == Rgb{0.1f, 0.2f, 0.3f});
  m = material("void plastic m 0 0 5 .1 .2 .3 .04 .1");
  CHECK(m.ior == 0);  // rough gloss: .04 at all angles
  CHECK(m.specular.value == 0.04f);
  CHECK(m.roughness.value == 0.1f);
  m = material("void plastic m 0 0 5 .1 .2 .3 .04 0");
  CHECK(m.ior == doctest::Approx(1.5));  // reflects .04 at normal incidence
  CHECK(m.specular.value == 1);
  m = material("void plastic m 0 0 5 .1 .2 .3 .01 0");  // below Radiance's minimum for Fresnel
  CHECK(m.ior == 0);
  m = material("void metal m 0 0 5 .8 .7 .6 .9 .05");
  CHECK(m.metallic.value == 0.9f);
  m = material("void mirror m 0 0 3 .8 .7 .6");
  CHECK(m.is_reflectance);
  m = material("void dielectric m 0 0 5 1 1 1 1.33 0");
  CHECK(m.ior == 1.33f);
  CHECK_FALSE(m.is_thin);
  // The reference manual's example: a transmissivity of 0.96 is a transmittance of 0.88.
  m = material("void glass m 0 0 3 .96 .96 .96");
  REQUIRE(m.is_thin);
  const double r = sqr(0.52 / 2.52), t = std::exp(-double(m.absorption.r));
  CHECK(sqr(1 - r) * t / (1 - sqr(r * t)) == doctest::Approx(0.88).epsilon(0.002));
  CHECK(m.base_color.value == Rgb{1});
  m = material("void glass m 0 0 4 .96 .96 .96 1.7");
  CHECK(m.ior == 1.7f);
  // Aliases, and patterns that are not shown.
  m = material(
      "void colorpict p 7 red green blue x.hdr . u v 0 0\np metal q 0 0 5 .1 .2 .3 0 0\n"
      "void alias m q");
  CHECK(m.base_color.value == Rgb{0.1f, 0.2f, 0.3f});
  CHECK(import_text("void sphere s 0 0 4 0 0 0 1").spheres.empty());
}

TEST_CASE("reflection and transmission of a pane of trans") {
  const Scene scene =
      import_text("void trans m 0 0 7 1 1 1 0 0 .6 .5\nm polygon p 0 0 9 0 0 0 1 0 0 0 1 0");
  const Material& m = scene.materials.at(0);
  const float t = m.transmission.value, base = m.base_color.value.r;
  const float evenly = m.diffuse_transmission.value, color = m.diffuse_transmission_color.value.r;
  CHECK(base * (1 - t) * (1 - evenly) == doctest::Approx(0.4));
  CHECK(base * t == doctest::Approx(0.3));
  CHECK(color * (1 - t) * evenly == doctest::Approx(0.3));
  CHECK(scene.warnings.total() == 0);
}

TEST_CASE("views from comments and from the file beside the scene") {
  const Scene scene =
      import_text("#@rpict -vtv -vp 1 2 3 -vd 0 2 0 -vu 0 0 1 -vh 90 -vv 53.1301\n");
  const Camera& c = scene.cameras.at(0);
  CHECK(is_near(c.position, {1, 2, 3}));
  CHECK(is_near(c.forward, {0, 1, 0}));
  CHECK(is_near(c.right, {1, 0, 0}));
  CHECK(is_near(c.up, {0, 0, 1}));
  CHECK(c.half_extent == doctest::Approx(0.5));
  CHECK(c.aspect == doctest::Approx(2));
  const TempFolder folder;
  folder.write("a.vf", "rvu -vtl -vp 0 0 9 -vd 0 0 -1 -vu 0 1 0 -vh 4 -vv 2\nrvu -vtv -vp 0 0 1\n");
  const Scene beside = import_radiance(folder.write("a.rad", grey));
  REQUIRE(beside.cameras.size() == 2);
  CHECK(beside.cameras[0].kind == CameraKind::orthographic);
  CHECK(beside.cameras[0].half_extent == 1);
}

// Programs write materials and surfaces into separate files.
TEST_CASE("an undefined modifier is grey, with a warning") {
  const Scene scene = import_text("paint polygon p 0 0 9 0 0 0 1 0 0 0 1 0\n" + grey +
                                  "grey polygon q 0 0 9 0 0 1 1 0 1 0 1 1\nvoid plastic paint 0 0 "
                                  "5 .1 .1 .1 0 0\npaint polygon r 0 0 9 0 0 2 1 0 2 0 1 2");
  CHECK(has_warning(scene, "no modifier 'paint' is defined"));
  REQUIRE(scene.meshes.size() == 3);
  CHECK(scene.materials.at(scene.meshes[0].material).base_color.value == Rgb{0.5f});
  CHECK(scene.materials.at(scene.meshes[2].material).base_color.value == Rgb{0.1f});
}

TEST_CASE("unreadable input is an error with its place") {
  CHECK(error_of(grey + "grey sphere s 0 0 4 1 x") == "scene.rad:2:23: 'x' is not a number");
  CHECK(error_of(grey + "grey sphere s 0 0 4 1").find("the file ends within") != std::string::npos);
  CHECK(error_of("void wood w 0 0 0").find("'wood' is not a Radiance type") != std::string::npos);
  CHECK(error_of("!xform ../x.rad").find("leads out of the scene's folder") != std::string::npos);
  CHECK(error_of("!xform scene.rad").find("endlessly") != std::string::npos);
  CHECK(error_of("void alias a b\nvoid alias b a\na sphere s 0 0 4 0 0 0 1").find("endlessly") !=
        std::string::npos);
  CHECK(error_of(grey + "!genbox grey b 1 1 1 | xform -a 1000 -t 1 0 0 -a 1000 -t 0 1 0")
            .find("100000 copies") != std::string::npos);
  CHECK(error_of(grey + "grey polygon p 0 0 99999999999").find("number of arguments") !=
        std::string::npos);
  const TempFolder folder;
  CHECK_THROWS_WITH_AS(import_scene(folder.write("a.oct", "#?RADIANCE\n")),
                       doctest::Contains("give the .rad file"), InputError);
}

TEST_CASE("mutated Radiance files load or are refused") {
  const TempFolder folder;
  const std::string text =
      grey + bright +
      "void glass pane 0 0 3 .9 .9 .9\nvoid trans t 0 0 7 .8 .8 .8 .1 .05 .4 .5\n"
      "void mixfunc mix 4 grey pane .5 . 0 0\nvoid spotlight spot 0 0 7 5 5 5 60 0 0 -1\n"
      "void brightfunc sf 2 skybright skybright.cal 0 7 2 8 5 1 0 0 1\nsf glow sg 0 0 4 1 1 1 0\n"
      "bright polygon l 0 0 12 0 0 3 0 1 3 1 1 3 1 0 3\nmix ring r 0 0 8 0 0 0 0 0 1 .5 1\n"
      "spot polygon sp 0 0 9 0 0 2 0 1 2 1 0 2\n"
      "t cone c 0 0 8 0 0 0 0 0 3 1 .5\n!genbox grey b 1 2 3 | xform -rz 30 -a 3 -t 4 0 0\n"
      "pane bubble u 0 0 4 1 1 1 1\n# rvu -vp 0 0 1 -vd 1 0 0 -vh 60 -vv 40\n";
  const auto import = [&](const std::string& changed) {
    import_radiance(folder.write("scene.rad", changed));
  };
  test::check_mutations(text, 1500, import);
  // Skies take time in proportion to their images, so there are fewer.
  const std::string sky =
      "void brightfunc sf 2 skybright skybright.cal 0 7 2 8 5 1 0 0 1\nsf glow sg 0 0 4 1 1 1 0\n"
      "sg source sky 0 0 4 0 0 1 180\n";
  test::check_mutations(sky, 20, import);
}

}  // namespace test_radiance
