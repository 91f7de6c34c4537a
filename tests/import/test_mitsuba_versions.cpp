// Tests of Mitsuba files older than 0.4, and of differences between versions.
#include <doctest/doctest.h>

#include <cmath>
#include <string>

#include "base/error.h"
#include "base/sun_position.h"
#include "base/units.h"
#include "import/mitsuba/mitsuba.h"
#include "scene_checks.h"
#include "temp_folder.h"

using namespace troffer;

namespace test_mitsuba_versions {

namespace {

Scene import_world(const std::string& world, const std::string& attributes) {
  const TempFolder folder;
  return import_mitsuba(
      folder.write("scene.xml", "<scene " + attributes + ">" + world + "</scene>"));
}

Material material_of(const std::string& bsdf, const std::string& version) {
  const Scene scene =
      import_world("<shape type='sphere'>" + bsdf + "</shape>", "version='" + version + "'");
  REQUIRE(scene.materials.size() == 1);
  return scene.materials[0];
}

}  // namespace

TEST_CASE("files from before version 0.3 equal those of 0.6 with other names") {
  // A file without a version and with <camera> counts as older than 0.3.
  const Scene old = import_world(
      "<camera type='perspective'><float name='fov' value='40'/><transform name='toWorld'>"
      "<lookAt ox='1' oy='2' oz='9' tx='0' ty='0' tz='0' ux='0' uy='1' uz='0'/></transform>"
      "<film type='pngfilm'><integer name='width' value='40'/><integer name='height' value='20'/>"
      "</film></camera>"
      "<luminaire type='constant'><rgb name='intensity' value='2'/></luminaire>"
      "<shape type='sphere'><boolean name='inverted' value='true'/><bsdf type='lambertian'><rgb "
      "name='reflectance' value='.3'/></bsdf><luminaire type='area'><rgb name='intensity' "
      "value='5'/></luminaire></shape>",
      "");
  const Scene now = import_world(
      "<sensor type='perspective'><float name='fov' value='40'/><string name='fovAxis' "
      "value='smaller'/><transform name='toWorld'><lookAt origin='1,2,9' target='0,0,0' "
      "up='0,1,0'/></transform><film type='ldrfilm'><integer name='width' value='40'/><integer "
      "name='height' value='20'/></film></sensor>"
      "<emitter type='constant'><rgb name='radiance' value='2'/></emitter>"
      "<shape type='sphere'><boolean name='flipNormals' value='true'/><bsdf type='diffuse'><rgb "
      "name='reflectance' value='.3'/></bsdf><emitter type='area'><rgb name='radiance' "
      "value='5'/></emitter></shape>",
      "version='0.6.0'");
  CHECK(old.warnings.total() == 0);
  const Camera &a = old.cameras.at(0), &b = now.cameras.at(0);
  CHECK(a.half_extent == b.half_extent);
  CHECK(is_near(a.right, b.right));
  CHECK(is_near(a.forward, b.forward));
  REQUIRE(old.lights.size() == 2);
  for (size_t i = 0; i < 2; ++i) CHECK(old.lights[i].radiance == now.lights.at(i).radiance);
  CHECK(old.materials.at(0).base_color.value == Rgb{0.3f});
  CHECK(old.spheres.at(0).is_inside_out == now.spheres.at(0).is_inside_out);
}

TEST_CASE("cameras of version 0.3 have x to the right") {
  const auto right = [](const char* tag, const char* version) {
    return import_world(std::string("<") + tag +
                            " type='perspective'><transform name='toWorld'><lookAt "
                            "origin='0,0,5' target='0,0,0' up='0,1,0'/></transform></" +
                            tag + ">",
                        std::string("version='") + version + "'")
        .cameras.at(0)
        .right;
  };
  CHECK(is_near(right("camera", "0.3.0"), -right("sensor", "0.4.0")));
}

TEST_CASE("materials from before version 0.3") {
  Material m = material_of("<bsdf type='mirror'/>", "0.2.0");
  CHECK(m.kind == MaterialKind::conductor);
  m = material_of("<bsdf type='roughglass'><float name='alphaB' value='.2'/></bsdf>", "0.2.0");
  CHECK(m.kind == MaterialKind::dielectric);
  CHECK(m.roughness.value == 0.2f);
  m = material_of(
      "<bsdf type='phong'><float name='diffuseAmount' value='.5'/><rgb name='diffuseReflectance' "
      "value='.8'/></bsdf>",
      "0.2.0");
  CHECK(m.base_color.value.r == doctest::Approx(0.4));
  m = material_of("<bsdf type='ward'><float name='diffuseAmount' value='.5'/></bsdf>", "0.2.0");
  CHECK(m.base_color.value.r == doctest::Approx(0.25));
}

TEST_CASE("surfaces that only separate media are invisible up to version 0.6") {
  const std::string shape =
      "<shape type='sphere'><medium type='homogeneous' name='interior'><rgb name='sigmaS' "
      "value='1'/><rgb name='sigmaA' value='0'/></medium></shape>";
  CHECK(import_world(shape, "version='0.5.0'").spheres.empty());
  CHECK(import_world(shape, "version='3.0.0'").spheres.size() == 1);
}

TEST_CASE("Mitsuba's sun stands by place and time") {
  const std::string time =
      "<float name='latitude' value='48.2'/><float name='longitude' value='16.4'/><float "
      "name='timezone' value='2'/><integer name='year' value='2026'/><integer name='month' "
      "value='6'/><integer name='day' value='21'/><float name='hour' value='12'/>";
  const SunPosition at = sun_position(48.2, 16.4, julian_day(2026, 6, 21, 10));
  const double high = std::sin(rad_from_deg(at.altitude_deg));
  const double level = std::cos(rad_from_deg(at.altitude_deg));
  const double north = level * std::cos(rad_from_deg(at.azimuth_deg));
  const double east = level * std::sin(rad_from_deg(at.azimuth_deg));
  const Scene legacy =
      import_world("<emitter type='sunsky'>" + time + "</emitter>", "version='0.6.0'");
  REQUIRE(legacy.lights.size() == 2);
  CHECK(is_near(legacy.lights[1].direction, Vec3(-Vec3d{east, high, -north})));
  CHECK(is_near(legacy.lights[0].axes[2], {0, 1, 0}));
  const Scene now =
      import_world("<emitter type='sunsky'>" + time + "</emitter>", "version='3.0.0'");
  CHECK(is_near(now.lights.at(1).direction, Vec3(-Vec3d{north, east, high})));
  CHECK(is_near(now.lights.at(0).axes[2], {0, 0, 1}));
}

TEST_CASE("a sun's direction is the world's, whatever the emitter's transform") {
  const Scene scene = import_world(
      "<emitter type='sun'><transform name='to_world'><rotate x='1' angle='-90'/></transform>"
      "<vector name='sun_direction' x='1' y='1' z='0'/><float name='sun_aperture' value='2'/>"
      "</emitter>",
      "version='3.0.0'");
  REQUIRE(scene.lights.size() == 1);
  CHECK(is_near(scene.lights[0].direction, Vec3(-normalize(Vec3d{1, 1, 0}))));
  CHECK(double(scene.lights[0].angular_radius) == doctest::Approx(rad_from_deg(1)));
  CHECK(has_warning(import_world("<emitter type='sunsky'><float name='hour' value='1'/></emitter>",
                                 "version='3.0.0'"),
                    "below the horizon"));
}

TEST_CASE("bsdfs of an OBJ file's materials") {
  const TempFolder folder;
  folder.write("m.obj",
               "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nusemtl WoodFloor\nf 1 2 3\nusemtl wall\n"
               "f 1 3 4\nusemtl other\nf 2 3 4\n");
  const Scene scene = import_mitsuba(folder.write(
      "s.xml",
      "<scene version='0.6.0'><bsdf type='diffuse' id='a'><rgb name='reflectance' "
      "value='.1'/></bsdf><shape type='obj'><string name='filename' value='m.obj'/><ref "
      "name='WoodFloor' id='a'/><bsdf name='wall' type='diffuse'><rgb name='reflectance' "
      "value='.2'/></bsdf></shape></scene>"));
  REQUIRE(scene.meshes.size() == 3);
  CHECK(scene.materials.at(scene.meshes[0].material).base_color.value == Rgb{0.1f});
  CHECK(scene.materials.at(scene.meshes[1].material).base_color.value == Rgb{0.2f});
  CHECK(has_warning(scene, "without a bsdf of the same name"));
  // A single bsdf applies to the whole file, whatever its name.
  const Scene one = import_mitsuba(folder.write(
      "t.xml",
      "<scene version='0.6.0'><shape type='obj'><string name='filename' value='m.obj'/><bsdf "
      "name='wall' type='diffuse'/></shape></scene>"));
  CHECK(one.meshes.size() == 1);
}

// Mitsuba takes such parameters from its command line.
TEST_CASE("elements that use an undefined parameter without a default are left out") {
  const Scene scene = import_world(
      "<integrator type='$kind'><integer name='x' value='$depth'/></integrator><sensor "
      "type='perspective'><sampler type='independent'><integer name='sampleCount' "
      "value='$spp'/></sampler><film type='hdrfilm'><integer name='width' value='$width'/><integer "
      "name='height' value='100'/></film></sensor><shape type='sphere'/>",
      "version='0.6.0'");
  CHECK(scene.warnings.total() == 1);
  CHECK(has_warning(scene, "the parameter $width has no <default>: <integer width> is left out"));
  CHECK(scene.cameras.at(0).width == 768);
  CHECK(scene.cameras.at(0).height == 100);
}

}  // namespace test_mitsuba_versions
