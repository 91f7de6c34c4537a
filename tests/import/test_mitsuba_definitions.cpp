// Tests of Mitsuba's definitions, with values from its documentation and closed forms.
//
// References: [1] W. Jakob et al., "Mitsuba 3 documentation"; [2] its plugins' sources for tables.
#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "base/coat.h"
#include "base/error.h"
#include "base/facets.h"
#include "base/units.h"
#include "import/mitsuba/mitsuba.h"
#include "import/mitsuba/mitsuba_spectrum.h"
#include "scene_checks.h"
#include "temp_folder.h"

using namespace troffer;

namespace test_mitsuba_definitions {

namespace {

std::string scene_of(const std::string& world, const std::string& version = "3.0.0") {
  return "<scene version='" + version + "'>" + world + "</scene>";
}
Scene import_world(const std::string& world, const std::string& version = "3.0.0") {
  const TempFolder folder;
  return import_mitsuba(folder.write("scene.xml", scene_of(world, version)));
}

// Returns a bitmap of one pixel of three bytes.
std::string bmp(uint8_t r, uint8_t g, uint8_t b) {
  std::string s("BM\x3a\0\0\0\0\0\0\0\x36\0\0\0\x28\0\0\0\1\0\0\0\1\0\0\0\1\0\x18\0", 30);
  s.append(24, '\0');
  for (const uint8_t v : {b, g, r, uint8_t(0)}) s += char(v);
  return s;
}

// Returns the number that a bitmap of that colour gives.
float opacity_of(const std::string& pixel, const std::string& more = "") {
  const TempFolder folder;
  folder.write("t.bmp", pixel);
  const Scene s = import_mitsuba(folder.write(
      "a.xml", scene_of("<shape type='rectangle'><bsdf type='mask'><texture name='opacity' "
                        "type='bitmap'><string name='filename' value='t.bmp'/>" +
                        more + "</texture><bsdf type='diffuse'/></bsdf></shape>")));
  CHECK(s.warnings.total() == 0);
  return coverage(s.textures, s.materials.at(s.meshes.at(0).material), Vec2{0.5f, 0.5f});
}

Material material_of(const std::string& bsdf) {
  const Scene s = import_world("<shape type='sphere'>" + bsdf + "</shape>");
  REQUIRE(s.materials.size() == 1);
  return s.materials[0];
}

Rgb radiance_of(const std::string& parameter) {
  return import_world("<shape type='rectangle'><emitter type='area'>" + parameter +
                      "</emitter></shape>")
      .lights.at(0)
      .radiance;
}

bool is_near(Rgb a, Rgb b, float tolerance) {
  return std::abs(a.r - b.r) <= tolerance && std::abs(a.g - b.g) <= tolerance &&
         std::abs(a.b - b.b) <= tolerance;
}

const std::string checks =
    "<bsdf type='diffuse'><texture name='reflectance' type='checkerboard'/></bsdf>";

}  // namespace

TEST_CASE("a camera without fov has a lens of 50 mm on 36 x 24 mm, whose diagonals match") {
  const auto camera = [](const std::string& more, int height) {
    return import_world("<sensor type='perspective'>" + more +
                        "<film type='hdrfilm'><integer name='width' value='300'/><integer "
                        "name='height' value='" +
                        std::to_string(height) + "'/></film></sensor>")
        .cameras.at(0);
  };
  const double diagonal = std::hypot(36.0, 24.0) / 2 / 50;
  CHECK(deg_from_rad(2 * std::atan(double(camera("", 300).half_extent))) ==
        doctest::Approx(34.02).epsilon(1e-3));
  CHECK(camera("", 200).half_extent == doctest::Approx(diagonal / std::hypot(1.0, 1.5)));
  CHECK(camera("<string name='focal_length' value='25mm'/>", 200).half_extent ==
        doctest::Approx(2 * diagonal / std::hypot(1.0, 1.5)));
  // fov_axis applies to fov only.
  CHECK(camera("<string name='fov_axis' value='y'/>", 200).half_extent ==
        doctest::Approx(diagonal / std::hypot(1.0, 1.5)));
  CHECK_THROWS_AS(
      camera("<float name='fov' value='30'/><string name='focal_length' value='50mm'/>", 200),
      InputError);
}

TEST_CASE("the offset of the principal point is added to places on the film") {
  const Camera c =
      import_world(
          "<sensor type='perspective'><float name='fov' value='90'/><float "
          "name='principal_point_offset_x' value='.25'/><float "
          "name='principal_point_offset_y' value='.125'/><film type='hdrfilm'><integer "
          "name='width' value='80'/><integer name='height' value='40'/></film></sensor>")
          .cameras.at(0);
  // Mitsuba's perspective.cpp shows at place s of the film, from 0 to 1, what a centred film shows
  // at s + offset. The optical axis is at 1/4 of the width and 3/8 of the height from the top.
  REQUIRE(c.has_screen_window);
  CHECK(c.screen_window[0] == doctest::Approx(-1));
  CHECK(c.screen_window[1] == doctest::Approx(3));
  CHECK(c.screen_window[2] == doctest::Approx(-1.25));
  CHECK(c.screen_window[3] == doctest::Approx(0.75));
}

TEST_CASE("near and far limits of a camera; cameras of a batch") {
  const Scene s = import_world(
      "<sensor type='batch'><sensor type='perspective' id='a'><float name='near_clip' value='3'/>"
      "<float name='far_clip' value='40'/></sensor><sensor type='thinlens' id='b'><float "
      "name='aperture_radius' value='.1'/></sensor></sensor>");
  REQUIRE(s.cameras.size() == 2);
  CHECK(s.cameras[0].near_clip == 3);
  CHECK(s.cameras[0].far_clip == 40);
  CHECK(s.cameras[1].near_clip == 0);
  CHECK_THROWS_AS(import_world("<sensor type='perspective'><float name='near_clip' value='3'/>"
                               "<float name='far_clip' value='2'/></sensor>"),
                  InputError);
}

TEST_CASE("(u,v) of cylinders and disks: azimuth from +x, distance from the middle") {
  const Scene tube = import_world("<shape type='cylinder'>" + checks + "</shape>");
  const Mesh& t = tube.meshes.at(0);
  for (size_t i = 0; i < t.positions.size(); ++i) {
    const Vec3& p = t.positions[i];
    const double turn = std::atan2(double(p.y), double(p.x)) / (2 * pi);
    CHECK(std::abs(std::remainder(double(t.uvs[i].x) - turn, 1.0)) < 1e-5);
    CHECK(t.uvs[i].y == p.z);
  }
  // The azimuth of an axis along +x starts at -z: Duff's basis.
  const Scene lying =
      import_world("<shape type='cylinder'><point name='p1' value='1 0 0'/>" + checks + "</shape>");
  const Mesh& l = lying.meshes.at(0);
  CHECK(is_near(l.positions.at(0), {0, 0, -1}));
  CHECK(l.uvs.at(0) == Vec2{0, 0});
  const Scene plate = import_world("<shape type='disk'>" + checks + "</shape>");
  CHECK(plate.disks.empty());
  const Mesh& d = plate.meshes.at(0);
  for (size_t i = 0; i < d.positions.size(); ++i) {
    const Vec3& p = d.positions[i];
    CHECK(d.uvs[i].x == doctest::Approx(std::hypot(p.x, p.y)).epsilon(1e-5));
    if (d.uvs[i].x < 0.01f) continue;
    const double turn = std::atan2(double(p.y), double(p.x)) / (2 * pi);
    CHECK(std::abs(std::remainder(double(d.uvs[i].y) - turn, 1.0)) < 1e-5);
  }
}

// [2], cube.cpp: a row per side, with the same four (u,v).
TEST_CASE("(u,v) of the cube's sides") {
  const Scene s = import_world("<shape type='cube'>" + checks + "</shape>");
  const Mesh& m = s.meshes.at(0);
  const auto uv_at = [&](const Vec3& p, const Vec3& normal) {
    for (const Triangle& t : m.triangles) {
      if (!is_near(Vec3(normalize(area_vector(m, t))), normal)) continue;
      for (const uint32_t v : t)
        if (is_near(m.positions[v], p)) return m.uvs[v];
    }
    return Vec2{-1, -1};
  };
  CHECK(uv_at({1, -1, -1}, {0, -1, 0}) == Vec2{0, 1});
  CHECK(uv_at({-1, -1, 1}, {0, -1, 0}) == Vec2{1, 0});
  CHECK(uv_at({1, 1, -1}, {0, 1, 0}) == Vec2{0, 1});
  CHECK(uv_at({-1, 1, 1}, {0, 1, 0}) == Vec2{1, 0});
  CHECK(uv_at({1, -1, -1}, {1, 0, 0}) == Vec2{0, 1});
  CHECK(uv_at({1, 1, 1}, {1, 0, 0}) == Vec2{1, 0});
  CHECK(uv_at({1, -1, 1}, {0, 0, 1}) == Vec2{0, 1});
  CHECK(uv_at({-1, -1, 1}, {-1, 0, 0}) == Vec2{0, 1});
  CHECK(uv_at({1, 1, -1}, {0, 0, -1}) == Vec2{0, 1});
}

TEST_CASE("meshes without (u,v) have those of the triangle's corners") {
  const TempFolder folder;
  folder.write("t.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 3\n");
  const Scene s = import_mitsuba(folder.write(
      "a.xml",
      scene_of("<shape type='obj'><string name='filename' value='t.obj'/>" + checks + "</shape>")));
  CHECK(s.meshes.at(0).uvs == std::vector<Vec2>{{0, 0}, {1, 0}, {0, 1}});
}

TEST_CASE("bitmaps used as numbers are sRGB unless raw; colours count by luminance") {
  const float grey = linear_from_srgb(188.0f / 255);
  CHECK(opacity_of(bmp(188, 188, 188)) == doctest::Approx(grey));
  const std::string raw = "<boolean name='raw' value='true'/>";
  CHECK(opacity_of(bmp(188, 188, 188), raw) == doctest::Approx(188.0 / 255));
  CHECK(opacity_of(bmp(255, 0, 0)) == doctest::Approx(0.2126).epsilon(1e-3));
  CHECK(opacity_of(bmp(0, 188, 0)) == doctest::Approx(0.7152 * double(grey)).epsilon(1e-3));
}

// [2], checkerboard.cpp: eval_1() returns the first colour where eval() returns the second.
TEST_CASE("a checkerboard of numbers begins with the second number") {
  const auto at = [](const char* version) {
    const Scene s = import_world(
        "<shape type='rectangle'><bsdf type='mask'><texture name='opacity' type='checkerboard'>"
        "<float name='color0' value='.25'/><float name='color1' value='.75'/></texture><bsdf "
        "type='diffuse'/></bsdf></shape>",
        version);
    return coverage(s.textures, s.materials.at(s.meshes.at(0).material), Vec2{0.2f, 0.2f});
  };
  CHECK(at("3.0.0") == 0.75f);
  CHECK(at("0.6.0") == 0.25f);
}

TEST_CASE("spectra become the colours of Mitsuba's rgb modes") {
  // Values by [2], spectrum_list_to_srgb(), computed independently.
  CHECK(is_near(radiance_of("<spectrum name='radiance' value='400:0, 500:8, 600:15.6, 700:18.4'/>"),
                {20.7108f, 10.8546f, 2.7712f}, 1e-3f));
  CHECK(is_near(radiance_of("<spectrum name='radiance' value='520:0, 525:1, 545:1, 550:0'/>"),
                {0, 0.34226f, 0}, 1e-4f));
  CHECK(is_near(radiance_of("<spectrum name='radiance' value='2'/>"),
                Rgb{1.2048f, 0.9483f, 0.9089f} * 2, 1e-3f));
  CHECK(radiance_of("<float name='radiance' value='2'/>") == Rgb{2});
  CHECK(radiance_of("<rgb name='radiance' value='2'/>") == Rgb{2});
  const Material m = material_of(
      "<bsdf type='diffuse'><spectrum name='reflectance' value='400:.1, 700:.9'/></bsdf>");
  CHECK(is_near(m.base_color.value, {0.7429f, 0.4811f, 0.2083f}, 1e-3f));
  CHECK(material_of("<bsdf type='diffuse'><spectrum name='reflectance' value='.3'/></bsdf>")
            .base_color.value == Rgb{0.3f});
}

TEST_CASE("spectra as plugins") {
  const Rgb black_body = radiance_of("<blackbody name='radiance' temperature='3000'/>");
  CHECK(radiance_of("<spectrum type='blackbody' name='radiance'><float name='temperature' "
                    "value='3000'/></spectrum>") == black_body);
  CHECK(radiance_of("<spectrum type='irregular' name='radiance'><string name='wavelengths' "
                    "value='400, 500, 600, 700'/><string name='values' value='0, 8, 15.6, 18.4'/>"
                    "</spectrum>") ==
        radiance_of("<spectrum name='radiance' value='400:0, 500:8, 600:15.6, 700:18.4'/>"));
  CHECK(radiance_of("<spectrum type='regular' name='radiance'><float name='wavelength_min' "
                    "value='400'/><float name='wavelength_max' value='700'/><string name='values' "
                    "value='0, 8, 15.6, 18.4'/></spectrum>") ==
        radiance_of("<spectrum name='radiance' value='400:0, 500:8, 600:15.6, 700:18.4'/>"));
  CHECK(radiance_of("<spectrum type='d65' name='radiance'><float name='scale' value='4'/>"
                    "</spectrum>") == Rgb{4});
}

TEST_CASE("all metal names of Mitsuba are known") {
  for (const char* name :
       {"a-C",        "Ag",       "Al",        "AlAs",     "AlAs_palik", "AlSb",
        "AlSb_palik", "Au",       "Be",        "Be_palik", "Cr",         "CsI",
        "CsI_palik",  "Cu",       "Cu_palik",  "Cu2O",     "Cu2O_palik", "CuO",
        "CuO_palik",  "d-C",      "d-C_palik", "Hg",       "Hg_palik",   "HgTe",
        "HgTe_palik", "Ir",       "Ir_palik",  "K",        "K_palik",    "Li",
        "Li_palik",   "MgO",      "MgO_palik", "Mo",       "Mo_palik",   "Na_palik",
        "Nb",         "Nb_palik", "Ni_palik",  "Rh",       "Rh_palik",   "Se",
        "Se_palik",   "SiC",      "SiC_palik", "SnTe",     "SnTe_palik", "Ta",
        "Ta_palik",   "Te",       "Te_palik",  "ThF4",     "ThF4_palik", "TiC",
        "TiC_palik",  "TiN",      "TiN_palik", "TiO2",     "TiO2_palik", "VC",
        "VC_palik",   "V_palik",  "VN",        "VN_palik", "W"}) {
    CAPTURE(name);
    CHECK(mitsuba_metal(name));
  }
  CHECK_FALSE(mitsuba_metal("none"));
  // Aluminium as rgb renderers have it: the means of its tables over sRGB's curves.
  const MetalIndices al = *mitsuba_metal("Al");
  CHECK(is_near(al.eta, {1.6575f, 0.8804f, 0.5212f}, 1e-3f));
  CHECK(is_near(al.k, {9.2238f, 6.2695f, 4.8370f}, 1e-3f));
  const Material m = material_of(
      "<bsdf type='roughconductor'><string name='material' value='a-C'/><float name='alpha' "
      "value='.2'/><string name='distribution' value='ggx'/></bsdf>");
  CHECK(m.eta == mitsuba_metal("a-C")->eta);
  CHECK(m.facets == FacetModel::single_ggx);
  CHECK(material_of("<bsdf type='conductor'><float name='k' value='3'/></bsdf>").k == Rgb{3});
}

TEST_CASE("the base of rough plastic is tinted once unless nonlinear") {
  const auto base = [](const std::string& distribution, bool is_nonlinear) {
    const Material m =
        material_of("<bsdf type='roughplastic'><string name='distribution' value='" + distribution +
                    "'/><float name='alpha' value='.4'/><float name='int_ior' value='1.5'/><float "
                    "name='ext_ior' value='1'/><boolean name='nonlinear' value='" +
                    (is_nonlinear ? "true" : "false") +
                    "'/><rgb name='diffuse_reflectance' value='.5'/></bsdf>");
    CHECK(m.facets ==
          (distribution == "ggx" ? FacetModel::single_ggx : FacetModel::single_beckmann));
    return m.base_color.value.r;
  };
  for (const auto& [name, shape] :
       {std::pair{"ggx", FacetShape::ggx}, {"beckmann", FacetShape::beckmann}}) {
    const float f = mean_rough_reflectance_inside(shape, double(0.4f), 1.5);
    const float rho = base(name, false);
    CHECK(base(name, true) == 0.5f);
    CHECK(rho / (1 - rho * f) == doctest::Approx(double(0.5f / (1 - f))).epsilon(1e-4));
  }
}

}  // namespace test_mitsuba_definitions
