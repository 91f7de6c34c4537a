// Tests of Mitsuba's XML: syntax, transforms, cameras, shapes and their fronts, lights.
#include "import/mitsuba/mitsuba.h"

#include <doctest/doctest.h>

#include <cmath>
#include <string>

#include "base/error.h"
#include "import/mesh_clean.h"
#include "mutations.h"
#include "scene_checks.h"
#include "temp_folder.h"

using namespace troffer;

namespace test_mitsuba {

namespace {

Scene import_world(const std::string& world, const std::string& version = "3.0.0") {
  const TempFolder folder;
  return import_mitsuba(
      folder.write("scene.xml", "<scene version=\"" + version + "\">\n" + world + "\n</scene>"));
}

// Returns the message of the error that this world gives.
std::string error_of(const std::string& world) {
  try {
    import_world(world);
  } catch (const InputError& e) {
    const std::string what = e.what();
    return what.substr(what.find("scene.xml"));
  }
  return "";
}

const std::string area = "<emitter type='area'><rgb name='radiance' value='2 3 4'/></emitter>";

Light light_of_shape(const std::string& shape) {
  const Scene scene = import_world(shape);
  REQUIRE(scene.lights.size() == 1);
  return scene.lights[0];
}

}  // namespace

TEST_CASE("versions 0.6 and 3 of one scene are the same") {
  const std::string legacy =
      "<sensor type='perspective'><transform name='toWorld'><lookAt origin='1,2,3' target='1,2,9' "
      "up='0,1,0'/></transform><float name='fov' value='60'/><string name='fovAxis' value='y'/>"
      "<film type='hdrfilm'><integer name='width' value='40'/><integer name='height' value='20'/>"
      "</film></sensor><shape type='sphere'><float name='radius' value='2'/>"
      "<bsdf type='dielectric'><float name='intIOR' value='1.5'/><float name='extIOR' value='1'/>"
      "</bsdf></shape>";
  std::string modern = legacy;
  for (const auto& [old, now] : {std::pair{"toWorld", "to_world"},
                                 {"lookAt", "lookat"},
                                 {"fovAxis", "fov_axis"},
                                 {"intIOR", "int_ior"},
                                 {"extIOR", "ext_ior"}})
    for (size_t at = 0; (at = modern.find(old)) != std::string::npos;)
      modern.replace(at, std::string(old).size(), now);
  for (const Scene& scene : {import_world(legacy, "0.6.0"), import_world(modern)}) {
    CHECK(scene.warnings.entries().empty());
    const Camera& c = scene.cameras.at(0);
    CHECK(is_near(c.position, {1, 2, 3}));
    CHECK(is_near(c.forward, {0, 0, 1}));
    CHECK(is_near(c.up, {0, 1, 0}));
    CHECK(is_near(c.right, {-1, 0, 0}));  // +x is on the left: a right-handed picture
    CHECK(c.half_extent == doctest::Approx(std::tan(pi / 6)));
    CHECK(c.aspect == doctest::Approx(2));
    CHECK(scene.spheres.at(0).radius == 2);
    CHECK(scene.materials.at(0).ior == 1.5f);
  }
}

TEST_CASE("fields of view along every axis are one camera") {
  // 40 × 20 pixels; half of the height at distance 1 is 0.5 in all cases.
  for (const auto& [axis, tangent] : {std::pair{"x", 1.0},
                                      {"y", 0.5},
                                      {"smaller", 0.5},
                                      {"larger", 1.0},
                                      {"diagonal", std::sqrt(1.25)}}) {
    CAPTURE(axis);
    const Scene scene = import_world(
        "<sensor type='perspective'><float name='fov' value='" +
        std::to_string(2 * deg_from_rad(std::atan(tangent))) +
        "'/><string name='fov_axis' value='" + axis +
        "'/><film type='hdrfilm'><integer name='width' value='40'/><integer name='height' "
        "value='20'/></film></sensor>");
    CHECK(scene.cameras.at(0).half_extent == doctest::Approx(0.5));
  }
}

TEST_CASE("the film's crop is that part of the picture") {
  const Scene scene = import_world(
      "<sensor type='thinlens'><float name='aperture_radius' value='.1'/><float "
      "name='focus_distance' value='3'/><film type='hdrfilm'><integer name='width' value='40'/>"
      "<integer name='height' value='20'/><integer name='crop_offset_x' value='30'/><integer "
      "name='crop_offset_y' value='0'/><integer name='crop_width' value='10'/><integer "
      "name='crop_height' value='5'/></film></sensor>");
  const Camera& c = scene.cameras.at(0);
  CHECK(c.width == 10);
  CHECK(c.height == 5);
  CHECK(c.lens_radius == 0.1f);
  CHECK(c.focal_distance == 3);
  REQUIRE(c.has_screen_window);
  CHECK(c.screen_window == std::array<float, 4>{1, 2, 0.5f, 1});
}

TEST_CASE("transforms apply in the order of the file") {
  const auto centre = [](const std::string& transform) {
    const Scene scene = import_world(
        "<shape type='sphere'><point name='center' x='1' y='0' z='0'/><transform "
        "name='to_world'>" +
        transform + "</transform></shape>");
    return scene.spheres.at(0).centre;
  };
  CHECK(is_near(centre("<scale value='2'/><translate x='1'/>"), {3, 0, 0}));
  CHECK(is_near(centre("<translate x='1'/><scale value='2, 2 2'/>"), {4, 0, 0}));
  CHECK(is_near(centre("<rotate z='1' angle='90'/>"), {0, 1, 0}));
  CHECK(is_near(centre("<matrix value='0 -1 0 5 1 0 0 6 0 0 1 7 0 0 0 1'/>"), {5, 7, 7}));
  CHECK(is_near(centre("<matrix value='0 -1 0 1 0 0 0 0 1'/>"), {0, 1, 0}));
  CHECK(is_near(centre("<lookat origin='1,1,1' target='1,1,5' up='0,1,0'/>"), {2, 1, 1}));
}

TEST_CASE("surfaces emit from the side of their normals, mirrored or not") {
  for (const std::string type : {"rectangle", "disk"}) {
    for (const bool is_mirrored : {false, true}) {
      for (const bool is_flipped : {false, true}) {
        CAPTURE(type);
        CAPTURE(is_mirrored);
        CAPTURE(is_flipped);
        const Scene scene =
            import_world("<shape type='" + type + "'>" + area +
                         "<transform name='to_world'><scale x='" + (is_mirrored ? "-1" : "1") +
                         "' y='1' z='1'/></transform><boolean name='flip_normals' "
                         "value='" +
                         (is_flipped ? "true" : "false") + "'/></shape>");
        REQUIRE(scene.lights.size() == 1);
        CHECK(scene.lights[0].radiance == Rgb{2, 3, 4});
        CHECK_FALSE(scene.lights[0].is_two_sided);
        CHECK(is_near(front_of(scene, scene.lights[0]), {0, 0, is_flipped ? -1.0f : 1.0f}));
        // A light without bsdf reflects nothing.
        CHECK(scene.materials.at(0).base_color.value == Rgb{0});
      }
    }
  }
}

TEST_CASE("cube, cylinder and sphere have their fronts outside and their areas") {
  const auto area_and_volume = [](const std::string& type) {
    const Scene scene = import_world("<shape type='" + type +
                                     "'><transform name='to_world'><scale x='-1' y='1' z='1'/>"
                                     "</transform></shape>");
    const Mesh& m = scene.meshes.at(0);
    double area_sum = 0, volume = 0;
    for (const Triangle& t : m.triangles) {
      const Vec3d n = area_vector(m, t);
      area_sum += length(n) / 2;
      volume += dot(n, Vec3d(m.positions[t[0]])) / 6;
    }
    return std::pair{area_sum, volume};
  };
  CHECK(area_and_volume("cube").first == doctest::Approx(24));
  CHECK(area_and_volume("cube").second == doctest::Approx(8));
  CHECK(area_and_volume("cylinder").first == doctest::Approx(2 * pi).epsilon(0.01));
  CHECK(area_and_volume("cylinder").second == doctest::Approx(2 * pi / 3).epsilon(0.01));
  CHECK(import_world("<shape type='sphere'/>").spheres.size() == 1);
}

TEST_CASE("groups are shown by their instances") {
  const Scene scene = import_world(
      "<shape type='shapegroup' id='g'><shape type='sphere'/><shape type='cube'/></shape>"
      "<shape type='instance'><ref id='g'/><transform name='to_world'><translate x='10'/>"
      "</transform></shape><shape type='instance'><ref id='g'/></shape>");
  REQUIRE(scene.spheres.size() == 2);
  CHECK(scene.meshes.size() == 2);
  CHECK(is_near(scene.spheres[0].centre, {10, 0, 0}));
  CHECK(is_near(scene.spheres[1].centre, {0, 0, 0}));
}

TEST_CASE("defaults, includes, aliases and references") {
  const TempFolder folder;
  folder.write("sub/part.xml",
               "<scene version='3.0.0'><bsdf type='diffuse' id='red'><rgb "
               "name='reflectance' value='$r 0 0'/></bsdf></scene>");
  const Scene scene = import_mitsuba(folder.write(
      "a.xml",
      "<?xml version='1.0'?><!-- a comment --><scene version='2.1.0'><default name='r' "
      "value='.25'/><default name='r' value='.75'/><include filename='sub/part.xml'/>"
      "<alias id='red' as='rouge'/><shape type='sphere'><ref id='rouge'/></shape></scene>"));
  CHECK(scene.materials.at(scene.spheres.at(0).material).base_color.value == Rgb{0.25f, 0, 0});
}

TEST_CASE("an area light that shapes refer to") {
  const Scene scene = import_world(
      "<shape type='disk'><ref id='a'/></shape><emitter type='area' id='a'><rgb name='radiance' "
      "value='3'/></emitter>");
  CHECK(scene.warnings.entries().empty());
  REQUIRE(scene.lights.size() == 1);
  CHECK(scene.lights[0].name == "a");
}

TEST_CASE("lights without surface") {
  const Scene scene = import_world(
      "<emitter type='point'><point name='position' x='1' y='2' z='3'/><rgb name='intensity' "
      "value='5'/></emitter>"
      "<emitter type='spot'><transform name='to_world'><lookat origin='0,0,0' target='0,0,-1' "
      "up='0,1,0'/></transform><float name='cutoff_angle' value='60'/></emitter>"
      "<emitter type='directional'><vector name='direction' x='0' y='-2' z='0'/><rgb "
      "name='irradiance' value='7'/></emitter>"
      "<emitter type='constant'><rgb name='radiance' value='.5'/></emitter>");
  REQUIRE(scene.lights.size() == 4);
  CHECK(is_near(scene.lights[0].position, {1, 2, 3}));
  CHECK(scene.lights[0].radiance == Rgb{5});
  CHECK(is_near(scene.lights[1].direction, {0, 0, -1}));
  CHECK(scene.lights[1].cos_outer == doctest::Approx(0.5));
  CHECK(scene.lights[1].cos_inner == doctest::Approx(std::cos(pi / 4)));
  CHECK(is_near(scene.lights[2].direction, {0, -1, 0}));
  CHECK(scene.lights[2].radiance == Rgb{7});
  CHECK(scene.lights[3].kind == LightKind::environment);
  CHECK(scene.lights[3].radiance == Rgb{0.5f});
}

TEST_CASE("an environment image has +y up and -z at its edge") {
  const TempFolder folder;
  // PFM, grey, 4 × 2; rows from the bottom up.
  std::string pfm = "Pf\n4 2\n-1.0\n";
  for (const float v : {0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 1.0f, 0.0f, 0.0f})
    pfm.append(reinterpret_cast<const char*>(&v), sizeof v);
  folder.write("sky.pfm", pfm);
  const Scene scene = import_mitsuba(
      folder.write("a.xml",
                   "<scene version='3.0.0'><emitter type='envmap'><string name='filename' "
                   "value='sky.pfm'/><float name='scale' value='3'/></emitter></scene>"));
  const Light& e = scene.lights.at(0);
  CHECK(e.radiance == Rgb{3});
  CHECK(is_near(e.axes[0], {0, 0, -1}));
  CHECK(is_near(e.axes[1], {1, 0, 0}));
  CHECK(is_near(e.axes[2], {0, 1, 0}));
}

TEST_CASE("a black body at the freezing point of platinum has 60 cd per square centimetre") {
  // The definition of the candela from 1948 to 1979.
  const Light e = light_of_shape(
      "<shape type='rectangle'><emitter type='area'><blackbody name='radiance' "
      "temperature='2045'/></emitter></shape>");
  CHECK(double(luminance(e.radiance)) * 683 * 106.857 == doctest::Approx(6e5).epsilon(0.02));
}

TEST_CASE("spectra of sources keep their luminance") {
  const Light even = light_of_shape(
      "<shape type='rectangle'><emitter type='area'><spectrum name='radiance' value='3'/>"
      "</emitter></shape>");
  CHECK(luminance(even.radiance) == doctest::Approx(3).epsilon(1e-4));
  CHECK(even.radiance.r > even.radiance.g);  // equal-energy light
  const Light sampled = light_of_shape(
      "<shape type='rectangle'><emitter type='area'><spectrum name='radiance' value='300:3, "
      "900:3'/></emitter></shape>");
  CHECK(luminance(sampled.radiance) == doctest::Approx(3).epsilon(1e-4));
}

TEST_CASE("impossible values are errors with their place") {
  CHECK(error_of("<shape type='sphere'>\n  <float name='radius' value='two'/></shape>") ==
        "scene.xml:3:4: 'two' is not a number");
  CHECK(error_of("<shape type='sphere'>\n<ref id='nothing'/></shape>") ==
        "scene.xml:3:2: no element has the id 'nothing'");
  CHECK(error_of("<include filename='$x'/>") == "scene.xml:2:2: the parameter $x has no <default>");
  CHECK(error_of("<shape type='ply'><string name='filename' value='../x.ply'/></shape>")
            .find("leads out of the scene's folder") != std::string::npos);
  CHECK(error_of("<include filename='/etc/passwd'/>").find("absolute paths") != std::string::npos);
  CHECK(error_of("<include filename='scene.xml'/>").find("too many files, or itself") !=
        std::string::npos);
  CHECK(error_of("<shape").find("XML") != std::string::npos);
  CHECK(error_of("<bsdf type='twosided' id='a'><ref id='a'/></bsdf><shape type='sphere'><ref "
                 "id='a'/></shape>")
            .find("too deeply") != std::string::npos);
  CHECK(error_of("<shape type='shapegroup' id='g'><shape type='instance'><ref id='g'/></shape>"
                 "</shape><shape type='instance'><ref id='g'/></shape>")
            .find("too deeply") != std::string::npos);
}

TEST_CASE("endlessly expanding text is refused") {
  std::string world = "<default name='a0' value='xxxxxxxxxx'/>";
  for (int i = 0; i < 40; ++i) {
    const std::string last = std::to_string(i);
    world +=
        "<default name='a" + std::to_string(i + 1) + "' value='$a" + last + "$a" + last + "'/>";
  }
  CHECK(error_of(world).find("too much text") != std::string::npos);
}

TEST_CASE("unsupported features are named") {
  const Scene scene = import_world(
      "<shape type='hair'/><bsdf type='irawan' id='i'/><shape type='sphere'><ref id='i'/><medium "
      "type='homogeneous'/><float name='wobble' value='1'/></shape><emitter type='collimated'/>"
      "<thing/>");
  for (const char* part :
       {"shape \"hair\"", "bsdf \"irawan\"", "participating media",
        "shape \"sphere\": 'wobble' is not used", "emitter \"collimated\"", "<thing>"}) {
    CAPTURE(part);
    CHECK(has_warning(scene, part));
  }
}

TEST_CASE("mutated files load or are refused") {
  const TempFolder folder;
  const std::string text =
      "<scene version='3.0.0'><default name='w' value='64'/><sensor type='perspective'><transform "
      "name='to_world'><lookat origin='0,-5,1' target='0,0,1' up='0,0,1'/></transform><film "
      "type='hdrfilm'><integer name='width' value='$w'/></film></sensor><bsdf type='twosided' "
      "id='m'><bsdf type='roughplastic'><spectrum name='diffuse_reflectance' value='400:.1, "
      "700:.9'/><float name='alpha' value='.2'/></bsdf></bsdf><shape type='rectangle'><ref "
      "id='m'/><transform name='to_world'><scale value='3'/><rotate x='1' angle='30'/></transform>"
      "</shape><shape type='shapegroup' id='g'><shape type='cube'><bsdf type='mask'><texture "
      "type='checkerboard' name='opacity'><rgb name='color0' value='#ff8000'/></texture><bsdf "
      "type='conductor'><string name='material' value='Au'/></bsdf></bsdf></shape></shape><shape "
      "type='instance'><ref id='g'/></shape><shape type='sphere'><point name='center' value='0 0 "
      "4'/><emitter type='area'><blackbody name='radiance' temperature='3000' scale='1e-3'/>"
      "</emitter></shape><emitter type='spot'><float name='cutoff_angle' value='30'/></emitter>"
      "<emitter type='sunsky'><vector name='sun_direction' x='1' y='1' z='0'/></emitter></scene>";
  test::check_mutations(text, 1500, [&](const std::string& changed) {
    import_mitsuba(folder.write("scene.xml", changed));
  });
}

}  // namespace test_mitsuba
