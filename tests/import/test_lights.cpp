// Tests of lights without surface in pbrt and glTF, and of environment images.
#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <cstring>

#include "base/error.h"
#include "base/units.h"
#include "gltf_builder.h"
#include "import/environment_file.h"
#include "import/gltf/gltf.h"
#include "import/light_radius.h"
#include "import/pbrt/pbrt.h"
#include "mutations.h"
#include "scene/environment_lookup.h"
#include "scene/projected_image.h"
#include "temp_folder.h"

using namespace troffer;

namespace test_lights {

namespace {

Scene import_world(const std::string& world) {
  const TempFolder folder;
  return import_pbrt(folder.write("scene.pbrt", "WorldBegin\n" + world));
}

bool has_text(const Scene& scene, const std::string& part) {
  for (const Warning& w : scene.warnings.entries())
    if (w.text.find(part) != std::string::npos) return true;
  return false;
}

std::string pfm(int width, int height, const std::vector<float>& rgb) {
  std::string bytes = "PF\n" + std::to_string(width) + " " + std::to_string(height) + "\n-1\n";
  // PFM stores rows from the bottom up.
  for (int y = height - 1; y >= 0; --y)
    bytes.append(reinterpret_cast<const char*>(rgb.data() + size_t(y) * size_t(width) * 3),
                 size_t(width) * 3 * sizeof(float));
  return bytes;
}

Light only_light(const Scene& scene) {
  REQUIRE(scene.lights.size() == 1);
  return scene.lights[0];
}

std::string gltf_with(const std::string& light, const std::string& node = "") {
  std::string text =
      "{'asset':{'version':'2.0'},'extensionsUsed':['KHR_lights_punctual'],"
      "'extensions':{'KHR_lights_punctual':{'lights':[" +
      light + "]}},'nodes':[{'extensions':{'KHR_lights_punctual':{'light':0}}" + node + "}]}";
  for (char& c : text)
    if (c == '\'') c = '"';
  return text;
}
Scene import_light(const std::string& light, const std::string& node = "") {
  const TempFolder folder;
  return import_gltf(folder.write("scene.gltf", gltf_with(light, node)));
}

}  // namespace

TEST_CASE("pbrt's point, spot and distant lights") {
  Light e =
      only_light(import_world("Translate 1 2 3 LightSource \"point\" \"rgb I\" [1 2 3] "
                              "\"float scale\" 2 \"point3 from\" [0 0 1]"));
  CHECK(e.kind == LightKind::point);
  CHECK(e.name == "light0");
  CHECK(e.position == Vec3{1, 2, 4});
  CHECK(e.radiance == Rgb{2, 4, 6});
  e = only_light(import_world("LightSource \"point\" \"float power\" 20"));
  CHECK(double(e.radiance.g) == doctest::Approx(20 / (4 * pi)));

  e = only_light(
      import_world("Rotate 90 1 0 0 LightSource \"spot\" \"rgb I\" [5 5 5] \"point3 from\" "
                   "[0 0 0] \"point3 to\" [0 2 0] \"float coneangle\" 40 "
                   "\"float conedeltaangle\" 10"));
  CHECK(e.kind == LightKind::spot);
  CHECK(length(e.direction - Vec3{0, 0, 1}) < 1e-6f);
  CHECK(double(e.cos_inner) == doctest::Approx(std::cos(pi / 6)));
  CHECK(double(e.cos_outer) == doctest::Approx(std::cos(rad_from_deg(40.0))));
  CHECK(e.falloff == SpotFalloff::smooth_step);

  e = only_light(
      import_world("Scale 3 3 3 LightSource \"distant\" \"rgb L\" [1 1 1] "
                   "\"float illuminance\" 7 \"point3 from\" [0 0 5] \"point3 to\" [0 3 5]"));
  CHECK(e.kind == LightKind::distant);
  CHECK(e.radiance == Rgb{7});
  CHECK(length(e.direction - Vec3{0, 1, 0}) < 1e-6f);
  // Area lights have numbers of their own.
  const Scene both = import_world(
      "LightSource \"point\" AreaLightSource \"diffuse\" \"rgb L\" [1 1 1] Shape \"sphere\"");
  REQUIRE(both.lights.size() == 2);
  CHECK(both.lights[0].name == "light0");
  CHECK(both.lights[1].name == "emitter0");
}

TEST_CASE("senseless pbrt lights are errors with a place, or warnings") {
  for (const char* bad :
       {"LightSource \"point\" \"float scale\" -1", "LightSource \"spot\" \"float coneangle\" 200",
        "LightSource \"point\" \"point3 from\" [0 0 0 1 1 1]",
        "LightSource \"infinite\" \"rgb L\" [1 1 1] \"string filename\" \"a.pfm\""}) {
    CAPTURE(bad);
    try {
      import_world(bad);
      FAIL("loads");
    } catch (const InputError& error) {
      CHECK(error.line() == 2);
    }
  }
  for (const char* odd : {"LightSource \"distant\" \"point3 from\" [0 0 1]",
                          "LightSource \"point\" \"rgb I\" [1e38 1 1] \"float scale\" 1e38",
                          "LightSource \"infinite\" \"string filename\" \"missing.exr\"",
                          "LightSource \"infinite\" \"string filename\" \"../x.exr\"",
                          "LightSource \"goniometric\" \"string filename\" \"x.exr\""}) {
    const Scene scene = import_world(odd);
    CAPTURE(odd);
    CHECK(scene.lights.empty());
    CHECK(has_text(scene, "left out"));
  }
}

TEST_CASE("pbrt portals are rectangles in world space; others are ignored with a warning") {
  const auto with = [](const std::string& corners, const std::string& before = "") {
    return import_world(before + "LightSource \"infinite\" \"point3 portal\" [" + corners + "]");
  };
  const Scene scene = with("0 0 0 0 0 2 3 0 2 3 0 0", "Translate 5 5 5 Scale 2 2 2 ");
  const Light e = only_light(scene);
  REQUIRE(e.portal.size() == 4);
  CHECK(e.portal[1] == Vec3{0, 0, 2});
  CHECK(e.portal[2] == Vec3{3, 0, 2});
  CHECK(scene.warnings.entries().empty());
  for (const char* odd :
       {"0 0 0 1 0 0 1 1 0 0 1 .1", "0 0 0 1 0 0 1 1 0", "0 0 0 0 0 0 0 0 0 0 0 0",
        "0 0 0 1 0 0 1 1 0 0 1 0 2 2 2", "0 0 0 1 0 0 2 1 0 1 1 0",
        "0 0 0 1e30 0 0 1e30 1e-30 0 0 1e-30 0", "0 0 0 1 0 0 0 0 0 0 1 0"}) {
    CAPTURE(odd);
    const Scene left = with(odd);
    CHECK(only_light(left).portal.empty());
    CHECK(has_text(left, "portal is not a rectangle"));
  }
}

TEST_CASE("pbrt's infinite lights: uniform, and images rotated by the transform") {
  Light e =
      only_light(import_world("LightSource \"infinite\" \"rgb L\" [1 2 3] \"float scale\" 2"));
  CHECK(e.kind == LightKind::environment);
  CHECK(e.radiance == Rgb{2, 4, 6});
  e = only_light(import_world("LightSource \"infinite\" \"float illuminance\" 6"));
  CHECK(double(e.radiance.g) == doctest::Approx(6 / pi));

  const TempFolder folder;
  constexpr int n = 32;
  std::vector<float> texels(size_t(n) * n * 3, 0.5f);
  folder.write("square.pfm", pfm(n, n, texels));
  const auto with = [&](const std::string& world) {
    return import_pbrt(folder.write("scene.pbrt", "WorldBegin\n" + world));
  };
  const Scene turned = with(
      "Rotate 90 0 0 1 LightSource \"infinite\" \"string filename\" \"square.pfm\" "
      "\"float illuminance\" 10");
  e = only_light(turned);
  REQUIRE(turned.environments.size() == 1);
  CHECK(turned.environments[0].projection == SphereMap::equal_area);
  CHECK(length(e.axes[0] - Vec3{0, 1, 0}) < 1e-6f);
  CHECK(length(e.axes[1] - Vec3{-1, 0, 0}) < 1e-6f);
  CHECK(double(e.radiance.g) == doctest::Approx(10 / (0.5 * pi)).epsilon(0.01));
  const Scene mirrored =
      with("Scale -1 1 1 LightSource \"infinite\" \"string filename\" \"square.pfm\"");
  e = only_light(mirrored);
  CHECK(length(e.axes[0] - Vec3{-1, 0, 0}) < 1e-6f);
  CHECK(length(e.axes[1] - Vec3{0, 1, 0}) < 1e-6f);
  CHECK(mirrored.warnings.entries().empty());
}

TEST_CASE("environment images: NaN, negative, infinite and huge values") {
  const TempFolder folder;
  std::vector<float> texels(8 * 4 * 3, 1.0f);
  texels[0] = NAN;
  texels[5] = -3;
  texels[20] = INFINITY;
  texels[30] = 1e35f;
  WarningLog warnings;
  EnvironmentMap map = read_environment(folder.write("odd.pfm", pfm(8, 4, texels)), warnings);
  CHECK(map.projection == SphereMap::lat_long);
  CHECK(warnings.total() == 2);
  for (const Rgb& t : map.texels) {
    REQUIRE(is_finite(t));
    CHECK(t.r >= 0);
    CHECK(t.g >= 0);
    CHECK(t.b >= 0);
  }
  CHECK(map.texels[0].r == 0);
  CHECK(map.texels[0].g == 1);
  CHECK(map.texels[1].b == 0);

  // A larger image than is kept: the mean must stay.
  constexpr int width = 6000, height = 3000;
  std::vector<float> large(size_t(width) * height * 3, 0.0f);
  for (size_t i = 0; i < large.size() / 2; ++i) large[i] = 2;
  WarningLog told;
  map = read_environment(folder.write("large.pfm", pfm(width, height, large)), told);
  CHECK(told.total() == 1);
  CHECK(map.texels.size() <= size_t(1) << 23);
  double mean = 0;
  for (const Rgb& t : map.texels) mean += double(t.g) / double(map.texels.size());
  CHECK(mean == doctest::Approx(1).epsilon(1e-3));

  CHECK_THROWS_AS(read_environment(folder.write("bad.pfm", "PF\n4 4\n-1\nab"), told), InputError);
  CHECK_THROWS_AS(read_environment(folder.write("text.exr", "hello"), told), InputError);
  CHECK_THROWS_AS(read_environment("/nonexistent/a.hdr", told), InputError);
}

TEST_CASE("the irradiance from a uniform image above is pi times its radiance") {
  for (const SphereMap projection : {SphereMap::lat_long, SphereMap::equal_area}) {
    EnvironmentMap map;
    map.projection = projection;
    map.width = map.height = 64;
    map.texels.assign(64 * 64, Rgb{1, 2, 3});
    const Rgb e = irradiance_from_above(map);
    CHECK(double(e.r) == doctest::Approx(pi).epsilon(1e-3));
    CHECK(double(e.b) == doctest::Approx(3 * pi).epsilon(1e-3));
  }
}

TEST_CASE("KHR_lights_punctual: points, spots and directional lights in their units") {
  Light e = only_light(
      import_light("{'type':'point','color':[1,0.5,0.25],'intensity':80,'range':5,'name':'bulb'}",
                   ",'translation':[1,2,3]"));
  CHECK(e.kind == LightKind::point);
  CHECK(e.name == "bulb");
  CHECK(e.radiance == Rgb{80, 40, 20});
  CHECK(e.position == Vec3{1, 2, 3});
  CHECK(e.range == 5);
  // Turned by 90 degrees around x: -z becomes +y.
  e = only_light(import_light("{'type':'directional','intensity':1000}",
                              ",'name':'sun','rotation':[0.70710678,0,0,0.70710678]"));
  CHECK(e.kind == LightKind::distant);
  CHECK(e.name == "sun");
  CHECK(e.radiance == Rgb{1000});
  CHECK(length(e.direction - Vec3{0, 1, 0}) < 1e-6f);
  e = only_light(import_light("{'type':'spot','intensity':7,'spot':{'innerConeAngle':0.3}}"));
  CHECK(e.kind == LightKind::spot);
  CHECK(e.falloff == SpotFalloff::square);
  CHECK(double(e.cos_inner) == doctest::Approx(std::cos(0.3)));
  CHECK(double(e.cos_outer) == doctest::Approx(std::cos(pi / 4)));
  CHECK(length(e.direction - Vec3{0, 0, -1}) < 1e-6f);
}

TEST_CASE("KHR_lights_punctual: an impossible light is left out, with its name and place") {
  for (const char* bad :
       {"{'intensity':3}", "{'type':'point','intensity':-1}", "{'type':'point','range':0}",
        "{'type':'point','color':[1,1]}",
        "{'type':'spot','spot':{'innerConeAngle':1,'outerConeAngle':0.5}}",
        "{'type':'spot','spot':{'outerConeAngle':3}}", "{'type':'point','intensity':1e300}"}) {
    CAPTURE(bad);
    const Scene without = import_light(bad, ",'name':'bulb'");
    CHECK(without.lights.empty());
    CHECK(has_text(without, "light 'bulb' cannot be used and is left out"));
  }
  const Scene flat = import_light("{'type':'directional'}", ",'scale':[1,1,0]");
  CHECK(flat.lights.empty());
  CHECK(has_text(flat, "left out"));
  // An unknown light type must not affect the rest of the file.
  const Scene other = import_light("{'type':'ambient'}");
  CHECK(other.lights.empty());
  CHECK(has_text(other, "'ambient' is not known; left out"));
}

TEST_CASE("pbrt's goniometric and projection lights") {
  const TempFolder folder;
  folder.write("web.pfm", pfm(4, 4, std::vector<float>(48, 2)));
  folder.write("slide.pfm", pfm(4, 2, std::vector<float>(24, 1)));
  const auto import = [&](const std::string& world) {
    return import_pbrt(folder.write("scene.pbrt", "WorldBegin\n" + world));
  };
  Scene s = import(
      "Translate 1 2 3 LightSource \"goniometric\" \"string filename\" \"web.pfm\" \"rgb I\" [1 2 "
      "3]");
  Light e = only_light(s);
  CHECK(e.kind == LightKind::point);
  CHECK(e.position == Vec3{1, 2, 3});
  CHECK(e.environment == 0);
  CHECK(e.axes[2] == Vec3{0, 1, 0});
  CHECK(e.radiance == Rgb{1, 2, 3});
  e = only_light(
      import("LightSource \"goniometric\" \"string filename\" \"web.pfm\" \"float power\" [8]"));
  CHECK(double(e.radiance.g) == doctest::Approx(8 / (8 * pi)));

  s = import("LightSource \"projection\" \"string filename\" \"slide.pfm\" \"float fov\" [90]");
  e = only_light(s);
  CHECK(e.kind == LightKind::point);
  CHECK(projected(s, e, {dot(e.axes[0], Vec3{1.9f, 0, 1}), 0, 1}) == Rgb{1});
  CHECK(projected(s, e, {dot(e.axes[0], Vec3{2.1f, 0, 1}), 0, 1}).is_black());
  CHECK(projected(s, e, {0, dot(e.axes[1], Vec3{0, 1.1f, 1}), 1}).is_black());
  CHECK(projected(s, e, {0, 0, -1}).is_black());
  // A rectangle of 4 × 2 seen from distance 1 in front of its middle.
  CHECK(double(projected_flux(s, e).g) ==
        doctest::Approx(4 * std::asin(2 * 1 / std::sqrt(5.0 * 2))).epsilon(1e-4));
  CHECK(import("LightSource \"goniometric\" \"string filename\" \"slide.pfm\"").lights.empty());
  CHECK(import("LightSource \"projection\" \"string filename\" \"gone.pfm\"").lights.empty());
}

TEST_CASE("the illuminance from images with few texels is that of lights") {
  // Bilinear between two rows, 3 at the top and 1 below. As a function of the zenith angle over pi:
  // 3 up to 1/4, then down to 1 at 3/4.
  EnvironmentMap map;
  map.width = 4;
  map.height = 2;
  map.texels.assign(8, Rgb{1});
  for (size_t i = 0; i < 4; ++i) map.texels[i] = Rgb{3};
  double sum = 0;
  constexpr int n = 100'000;
  for (int i = 0; i < n; ++i) {
    const double height = (i + .5) / n * pi / 2, v = height / pi;
    sum += (v < .25 ? 3 : 3 - 2 * (v - .25) / .5) * std::cos(height) * std::sin(height);
  }
  CHECK(double(irradiance_from_above(map).g) ==
        doctest::Approx(sum * 2 * pi * (pi / 2) / n).epsilon(1e-4));
}

TEST_CASE("glTF's measured luminaires: files, data, buffer views; places and factors") {
  const TempFolder folder;
  const std::string ies = "TILT=NONE\n1 -1 1 2 1 1 2 1 1 0\n1 1 9\n0 90\n0\n50 50\n";
  folder.write("lamp.ies", ies);
  const auto import = [&](const std::string& light, const std::string& instance) {
    std::string text =
        "{'asset':{'version':'2.0'},'extensionsUsed':['EXT_lights_ies'],'extensionsRequired':"
        "['EXT_lights_ies'],'extensions':{'EXT_lights_ies':{'lights':[" +
        light +
        "]}},'nodes':[{'name':'one','translation':[1,2,3],'extensions':{'EXT_lights_ies':{" +
        instance + "}}}]}";
    for (char& c : text)
      if (c == '\'') c = '"';
    return import_gltf(folder.write("scene.gltf", text));
  };
  for (const std::string& uri :
       {std::string("lamp.ies"),
        std::string(
            "data:application/x-ies-lm-63;base64,VElMVD1OT05FCjEgLTEgMSAyIDEgMSAyIDEgMSAwCjEg"
            "MSA5CjAgOTAKMAo1MCA1MAo=")}) {
    const Scene s = import("{'uri':'" + uri + "'}", "'light':0,'multiplier':2,'color':[1,0.5,2]");
    const Light e = only_light(s);
    CHECK(e.name == "one");
    CHECK(e.kind == LightKind::point);
    CHECK(e.position == Vec3{1, 2, 3});
    CHECK(e.radiance == Rgb{2, 1, 2});
    REQUIRE(e.web >= 0);
    CHECK(s.webs[size_t(e.web)].intensities[0] == 50);
    CHECK(e.axes[0] == Vec3{1, 0, 0});
    CHECK(e.axes[1] == Vec3{0, 1, 0});
    CHECK(e.axes[2] == Vec3{0, 0, -1});
  }
  // An index that names no light is an error of the document.
  CHECK_THROWS_AS(import("{'uri':'lamp.ies'}", "'light':1"), InputError);
  const std::array<std::pair<const char*, const char*>, 3> unusable{
      {{"{'uri':'gone.ies'}", "'light':0"},
       {"{'name':'nothing'}", "'light':0"},
       {"{'uri':'lamp.ies'}", "'light':0,'multiplier':-1"}}};
  for (const auto& [light, instance] : unusable) {
    CAPTURE(light);
    const Scene s = import(light, instance);
    CHECK(s.lights.empty());
    CHECK(has_text(s, "light 'one' cannot be used and is left out"));
  }
}

namespace {

std::string data_image(const std::string& bytes) {
  return "{'uri':'data:application/octet-stream;base64," + base64(bytes) + "'}";
}

// Returns 2 × 2 texels of one grey; the upper right one is ten times as bright.
std::string pfm_face(float grey) {
  std::vector<float> texels(12, grey);
  for (size_t i = 9; i < 12; ++i) texels[i] = 10 * grey;  // rows from the bottom up
  return "PF\n2 2\n-1\n" + bytes_of(texels);
}

std::string image_light(const std::string& images, const std::string& more = "") {
  return gltf_text("'extensionsUsed':['EXT_lights_image_based'],'images':[" + images +
                   "],'extensions':{'EXT_lights_image_based':{'lights':[{'intensity':3,"
                   "'specularImageSize':2,'specularImages':[[0,1,2,3,4,5]]" +
                   more +
                   "}]}},'scene':0,'scenes':[{'extensions':{'EXT_lights_image_based':{'light':0}"
                   "}}]");
}

float image_towards(const Scene& s, const Vec3& world) {
  const Light e = only_light(s);
  CHECK(e.kind == LightKind::environment);
  const EnvironmentMap& map = s.environments.at(size_t(e.environment));
  const Vec3 own{dot(world, e.axes[0]), dot(world, e.axes[1]), dot(world, e.axes[2])};
  return e.radiance.g * value_at(map, square_from_direction(map.projection, normalize(own))).g;
}

}  // namespace

TEST_CASE("glTF's image-based light: six faces as seen from inside, rotated and scaled") {
  std::string images;
  for (int i = 0; i < 6; ++i) images += (i > 0 ? "," : "") + data_image(pfm_face(float(i + 1)));
  const Scene plain = import_text(image_light(images));
  // Directions to the lower left of each face, whose upper right is brighter: right of +z is -x.
  const std::array<Vec3, 6> lower_left{Vec3{1, -.3f, -.3f}, {-1, -.3f, .3f}, {.3f, 1, .3f},
                                       {.3f, -1, -.3f},     {.3f, -.3f, 1},  {-.3f, -.3f, -1}};
  const std::array<Vec3, 6> upper_right{Vec3{1, .5f, .5f}, {-1, .5f, -.5f}, {-.5f, 1, -.5f},
                                        {-.5f, -1, .5f},   {-.5f, .5f, 1},  {.5f, .5f, -1}};
  for (size_t i = 0; i < 6; ++i) {
    CAPTURE(i);
    CHECK(image_towards(plain, lower_left[i]) == doctest::Approx(3 * float(i + 1)).epsilon(1e-4));
    CHECK(image_towards(plain, upper_right[i]) == doctest::Approx(30 * float(i + 1)).epsilon(1e-4));
  }
  // A quarter turn around y maps +z to +x.
  const Scene turned = import_text(image_light(images, ",'rotation':[0,0.70710678,0,0.70710678]"));
  CHECK(image_towards(turned, {1, -.3f, -.3f}) == doctest::Approx(15).epsilon(1e-4));

  // RGBD: grey 128 divided by an alpha of 51/255.
  std::string tga(18, '\0');
  tga[2] = 2;
  tga[12] = tga[14] = 1;
  tga[16] = 32;
  tga[17] = 8;
  tga += std::string("\x80\x80\x80\x33", 4);
  std::string packed;
  for (int i = 0; i < 6; ++i) packed += (i > 0 ? "," : "") + data_image(tga);
  CHECK(image_towards(import_text(image_light(packed)), {0, 1, 0}) ==
        doctest::Approx(3 * 5 * 0.2158605).epsilon(1e-4));

  const Scene broken = import_text(image_light(images + ",{'uri':'x'}", ",'name':'sky'"));
  CHECK(broken.lights.size() == 1);
  CHECK(import_text(image_light("{'uri':'gone.png'}")).lights.empty());
  const Scene unturned = import_text(image_light(images, ",'rotation':[0,0,0,0]"));
  CHECK(unturned.lights.empty());
  CHECK(has_text(unturned, "an image-based light cannot be used and is left out"));
}

TEST_CASE("mutated image-based lights load or are refused") {
  std::string images;
  for (int i = 0; i < 6; ++i) images += (i > 0 ? "," : "") + data_image(pfm_face(float(i + 1)));
  test::check_mutations(image_light(images), 1500, [](const std::string& text) {
    for (const Light& l : import_text(text).lights) CHECK(is_finite(l.radiance));
  });
}

TEST_CASE("--light-radius turns points and spots into spheres with the same light far away") {
  Scene s;
  Light e;
  e.kind = LightKind::point;
  e.radiance = Rgb{10};
  s.lights.push_back(e);
  e.kind = LightKind::spot;
  e.cos_outer = .5f;
  e.cos_inner = .8f;
  s.lights.push_back(e);
  e.kind = LightKind::distant;
  s.lights.push_back(e);
  give_radius(s, .1);
  REQUIRE(s.spheres.size() == 2);
  CHECK(s.lights[0].kind == LightKind::sphere);
  CHECK(double(s.lights[0].radiance.g) == doctest::Approx(10 / (pi * .01)));
  CHECK(s.lights[1].kind == LightKind::sphere);
  CHECK(s.lights[1].radiance == Rgb{10});
  const LightWeb& web = s.webs[size_t(s.lights[1].web)];
  CHECK(double(web.cross_section) == doctest::Approx(pi * .01));
  CHECK(web.intensities[0] == 1);
  CHECK(web.vertical_angles_rad.back() == doctest::Approx(std::acos(.5f)));
  CHECK(web.intensities.back() == doctest::Approx(0));
  CHECK(s.lights[2].kind == LightKind::distant);
  CHECK(s.spheres[1].light == 1);
}

}  // namespace test_lights
