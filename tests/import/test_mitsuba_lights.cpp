// Tests of Mitsuba's spots, projectors, mesh attributes and folders of files.
//
// References: [1] W. Jakob et al., "Mitsuba 3 documentation: Emitters, Textures".
#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <string>

#include "base/units.h"
#include "import/mitsuba/mitsuba.h"
#include "scene/projected_image.h"
#include "scene_checks.h"
#include "temp_folder.h"

using namespace troffer;

namespace test_mitsuba_lights {

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

bool is_near(Rgb a, Rgb b, float tolerance) {
  return std::abs(a.r - b.r) <= tolerance && std::abs(a.g - b.g) <= tolerance &&
         std::abs(a.b - b.b) <= tolerance;
}

}  // namespace

TEST_CASE("spots fade linearly in the angle and project pictures over their cone") {
  const TempFolder folder;
  folder.write("t.bmp", bmp(255, 188, 0));
  const Scene s = import_mitsuba(folder.write(
      "a.xml",
      scene_of("<emitter type='spot'><float name='cutoff_angle' value='30'/><float "
               "name='beam_width' value='10'/><texture name='texture' type='bitmap'><string "
               "name='filename' value='t.bmp'/></texture></emitter>")));
  CHECK(s.warnings.total() == 0);
  const Light& e = s.lights.at(0);
  CHECK(e.falloff == SpotFalloff::linear);
  CHECK(length(e.axes[0]) == doctest::Approx(1 / std::tan(rad_from_deg(30.0))));
  CHECK(is_near(projected(s, e, {0.3f, -0.2f, 1}), {1, linear_from_srgb(188.0f / 255), 0}, 1e-4f));
}

// By [1] the radiance between two rows is linear in the polar angle, from pole to pole.
TEST_CASE("the rows of an environment's image reach from pole to pole") {
  const TempFolder folder;
  std::string pfm = "Pf\n2 3\n-1.0\n";  // from the bottom up
  for (const float v : {4.0f, 4.0f, 2.0f, 2.0f, 1.0f, 1.0f})
    pfm.append(reinterpret_cast<const char*>(&v), sizeof v);
  folder.write("t.pfm", pfm);
  const Scene s = import_mitsuba(folder.write(
      "a.xml",
      scene_of("<emitter type='envmap'><string name='filename' value='t.pfm'/></emitter>")));
  const EnvironmentMap& map = s.environments.at(0);
  for (int y = 0; y < map.height; ++y) {
    const double v = (y + 0.5) / map.height;
    const double expected = v < 0.5 ? 1 + 2 * v : 2 + 4 * (v - 0.5);
    CHECK(map.texels[size_t(y * map.width)].g == doctest::Approx(expected));
  }
  CHECK(map.height > 16);
}

// A plane across the beam at distance z receives pi × irradiance / z² everywhere in the picture
// [1]. The intensity is pi irradiance / cos³, times cos / d² with d = z / cos.
TEST_CASE("a projector lights planes across its beam evenly") {
  const Scene s = import_world(
      "<emitter type='projector'><float name='fov' value='90'/><float name='scale' value='2'/><rgb "
      "name='irradiance' value='1 2 3'/></emitter>");
  CHECK(s.warnings.total() == 0);
  const Light& e = s.lights.at(0);
  CHECK(is_near(e.radiance, Rgb{2, 4, 6} * pi_f, 1e-4f));
  for (const auto& [x, y] : {std::pair{0.0f, 0.0f}, {0.9f, 0.0f}, {-0.5f, 0.8f}}) {
    const Vec3 p{x, y, 1};
    const double cosine = 1 / double(length(p));
    // Components along the light's axes.
    const Vec3 w{dot(p, e.axes[0]), dot(p, e.axes[1]), dot(p, e.axes[2])};
    CHECK(double(projected(s, e, w).g) * cosine * cosine * cosine == doctest::Approx(1));
  }
  const auto dark = [&](const Vec3& p) {
    return projected(s, e, {dot(p, e.axes[0]), dot(p, e.axes[1]), dot(p, e.axes[2])}).is_black();
  };
  CHECK(dark({1.1f, 0, 1}));
  CHECK(dark({0, 0, -1}));
}

TEST_CASE("a projected picture is oriented as a camera would see it") {
  const TempFolder folder;
  // PFM, from the bottom up: the upper left texel is 1.
  std::string pfm = "Pf\n2 2\n-1.0\n";
  for (const float v : {0.0f, 0.0f, 1.0f, 0.0f})
    pfm.append(reinterpret_cast<const char*>(&v), sizeof v);
  folder.write("t.pfm", pfm);
  const Scene s = import_mitsuba(folder.write(
      "a.xml", scene_of("<emitter type='projector'><float name='fov' value='90'/><texture "
                        "name='irradiance' type='bitmap'><string name='filename' value='t.pfm'/>"
                        "<string name='filter_type' value='nearest'/></texture></emitter>")));
  const Light& e = s.lights.at(0);
  const auto at = [&](const Vec3& p) {
    return projected(s, e, {dot(p, e.axes[0]), dot(p, e.axes[1]), dot(p, e.axes[2])}).g;
  };
  // Left is +x, up is +y.
  CHECK(at({0.5f, 0.5f, 1}) > 0);
  CHECK(at({-0.5f, 0.5f, 1}) == 0);
  CHECK(at({0.5f, -0.5f, 1}) == 0);
}

namespace {

const std::string coloured_ply =
    "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float "
    "z\nproperty float red\nproperty float green\nproperty float blue\nproperty float heat_0\n"
    "element face 2\nproperty list uchar int vertex_indices\nproperty float tone_1\nproperty float "
    "tone_2\nproperty float tone_3\nend_header\n"
    "0 0 0 1 0 0 .5\n1 0 0 0 1 0 .5\n1 1 0 0 0 1 .25\n0 1 0 0 0 0 1\n"
    "3 0 1 2 .1 .2 .3\n3 0 2 3 .4 .5 .6\n";

struct Coloured {
  Scene scene;
  // Returns the base colour at a point of a triangle, by barycentric shares.
  Rgb base(size_t triangle, std::array<float, 3> share) const {
    const Mesh& m = scene.meshes.at(0);
    Vec2 uv{0, 0};
    for (size_t k = 0; k < 3; ++k) uv = uv + m.uvs.at(m.triangles.at(triangle)[k]) * share[k];
    return evaluate(scene.textures, scene.materials.at(m.material).base_color, TexturePlace(uv));
  }
};
Coloured coloured(const std::string& bsdf) {
  const TempFolder folder;
  folder.write("t.ply", coloured_ply);
  return {import_mitsuba(folder.write(
      "a.xml",
      scene_of("<shape type='ply'><string name='filename' value='t.ply'/>" + bsdf + "</shape>")))};
}
std::string shown(const std::string& name) {
  return "<bsdf type='diffuse'><texture name='reflectance' type='mesh_attribute'><string "
         "name='name' value='" +
         name + "'/></texture></bsdf>";
}

}  // namespace

TEST_CASE("attributes of vertices and faces are textures") {
  const Coloured vertices = coloured(shown("vertex_color"));
  CHECK(vertices.scene.warnings.total() == 0);
  CHECK(is_near(vertices.base(0, {1, 0, 0}), {1, 0, 0}, 1e-5f));
  CHECK(is_near(vertices.base(0, {0.25f, 0.25f, 0.5f}), {0.25f, 0.25f, 0.5f}, 1e-5f));
  CHECK(is_near(vertices.base(1, {0, 0, 1}), {0, 0, 0}, 1e-5f));
  const Coloured faces = coloured(shown("face_tone"));
  CHECK(is_near(faces.base(0, {0.2f, 0.2f, 0.6f}), {0.1f, 0.2f, 0.3f}, 1e-5f));
  CHECK(is_near(faces.base(1, {0.6f, 0.2f, 0.2f}), {0.4f, 0.5f, 0.6f}, 1e-5f));
  const Coloured numbers = coloured(shown("vertex_heat"));
  CHECK(is_near(numbers.base(0, {0, 0, 1}), Rgb{0.25f}, 1e-5f));
  const Coloured weights = coloured(
      "<bsdf type='blendbsdf'><texture name='weight' type='mesh_attribute'><string name='name' "
      "value='vertex_heat'/></texture><bsdf type='diffuse'><rgb name='reflectance' value='0'/>"
      "</bsdf><bsdf type='diffuse'><rgb name='reflectance' value='.8'/></bsdf></bsdf>");
  CHECK(is_near(weights.base(1, {0, 0, 1}), Rgb{0.8f}, 1e-5f));
  CHECK(is_near(weights.base(0, {1, 0, 0}), Rgb{0.4f}, 1e-5f));
  CHECK(has_warning(coloured(shown("vertex_none")).scene, "no attribute 'vertex_none'"));
  CHECK(has_warning(import_world("<shape type='sphere'>" + shown("vertex_color") + "</shape>"),
                    "no attribute 'vertex_color'"));
}

TEST_CASE("one bsdf shows the attributes of each shape") {
  const TempFolder folder;
  folder.write("a.ply", coloured_ply);
  std::string other = coloured_ply;
  other.replace(other.find("0 0 0 1 0 0 .5"), 14, "0 0 0 0 0 1 .5");
  folder.write("b.ply", other);
  std::string world =
      "<texture type='mesh_attribute' id='t'><string name='name' "
      "value='vertex_color'/></texture><bsdf type='diffuse' id='m'><ref "
      "name='reflectance' id='t'/></bsdf>";
  for (const std::string name : {"a", "b"})
    world +=
        "<shape type='ply'><string name='filename' value='" + name + ".ply'/><ref id='m'/></shape>";
  const Scene s = import_mitsuba(folder.write("s.xml", scene_of(world)));
  REQUIRE(s.meshes.size() == 2);
  const auto first = [&](size_t i) {
    const Mesh& m = s.meshes[i];
    return evaluate(s.textures, s.materials.at(m.material).base_color,
                    TexturePlace(m.uvs.at(m.triangles.at(0)[0])));
  };
  CHECK(is_near(first(0), {1, 0, 0}, 1e-5f));
  CHECK(is_near(first(1), {0, 0, 1}, 1e-5f));
}

TEST_CASE("files are looked up in the folders of <path>, never outside of the scene's") {
  const TempFolder folder;
  folder.write("parts/t.bmp", bmp(255, 255, 255));
  const auto world = [&](const std::string& path) {
    return import_mitsuba(folder.write(
        "a.xml", scene_of("<path value='" + path +
                          "'/><shape type='rectangle'><bsdf type='diffuse'><texture "
                          "name='reflectance' type='bitmap'><string name='filename' value='t.bmp'/>"
                          "</texture></bsdf></shape>")));
  };
  CHECK(world("parts").warnings.total() == 0);
  CHECK(has_warning(world("../parts"), "leads out of"));
  CHECK(has_warning(world("elsewhere"), "t.bmp"));
}

}  // namespace test_mitsuba_lights
