// Tests of the options of MTL's maps, and of the resulting images.
#include <doctest/doctest.h>

#include <cmath>
#include <string>

#include "image/write_image.h"
#include "import/mesh/obj.h"
#include "scene_checks.h"
#include "temp_folder.h"

using namespace troffer;

namespace test_mtl_images {

namespace {

const std::string square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nvt 0 0\nvt 1 0\nvt 1 1\n";

// Imports a triangle with one material; the image is (.25, .5, 1) everywhere.
Scene import_material(const std::string& statements, const std::string& header = "") {
  const TempFolder folder;
  write_image(folder.path("i.pfm"), Image(1, 1, Rgb{0.25f, 0.5f, 1}));
  folder.write("m.mtl", header + "newmtl a\n" + statements + "\n");
  return import_obj(folder.write("m.obj", "mtllib m.mtl\n" + square + "usemtl a\nf 1/1 2/2 3/3\n"));
}
const Material& only(const Scene& scene) {
  return scene.materials.at(scene.meshes.at(0).material);
}
float value_of(const Scene& scene, const FloatInput& input) {
  return evaluate(scene.textures, input, Vec2{0.5f, 0.5f});
}

// One pixel (64, 128, 255) of 255, encoded with gamma 1 / 1.8 (gAMA).
const std::string png_of_gamma =
    "89504e470d0a1a0a0000000d4948445200000001000000010802000000907753de0000000467414d"
    "410000d904dcb2da020000000c49444154789c637068f80f0002c301c06fd260360000000049454e"
    "44ae426082";

std::string bytes_of_hex(const std::string& hex) {
  std::string bytes;
  for (size_t i = 0; i < hex.size(); i += 2)
    bytes += char(std::stoi(hex.substr(i, 2), nullptr, 16));
  return bytes;
}

}  // namespace

TEST_CASE("MTL: an image's colour profile is used for colours and ignored for data") {
  for (const std::string order : {"map_Kd i.png\nmap_Pr i.png", "map_Pr i.png\nmap_Kd i.png"}) {
    const TempFolder folder;
    folder.write("i.png", bytes_of_hex(png_of_gamma));
    folder.write("m.mtl", "newmtl a\nKd 1 1 1\nPr 1\n" + order + "\n");
    const Scene scene =
        import_obj(folder.write("m.obj", "mtllib m.mtl\n" + square + "usemtl a\nf 1/1 2/2 3/3\n"));
    CHECK(scene.warnings.total() == 0);
    const Rgb c = evaluate(scene.textures, only(scene).base_color, Vec2{0.5f, 0.5f});
    CHECK(double(c.r) == doctest::Approx(std::pow(64.0 / 255, 1.8)).epsilon(0.02));
    CHECK(double(c.g) == doctest::Approx(std::pow(128.0 / 255, 1.8)).epsilon(0.02));
    CHECK(c.b == 1);
    CHECK(double(value_of(scene, only(scene).roughness)) == doctest::Approx(64.0 / 255));
  }
}

TEST_CASE("MTL: -mm scales and shifts an image's values") {
  const Scene scene = import_material("Kd 1 1 1\nmap_Kd -mm .1 .8 i.pfm");
  CHECK(scene.warnings.total() == 0);
  const Rgb c = evaluate(scene.textures, only(scene).base_color, Vec2{0.5f, 0.5f});
  CHECK(c.r == doctest::Approx(0.3));
  CHECK(c.g == doctest::Approx(0.5));
  CHECK(c.b == doctest::Approx(0.9));
}

TEST_CASE("MTL: -imfchan selects the channel of a number") {
  for (const auto& [option, value] :
       {std::pair{"", 0.25}, std::pair{"-imfchan g", 0.5}, std::pair{"-imfchan b", 1.0},
        std::pair{"-imfchan l", 0.2126 * 0.25 + 0.7152 * 0.5 + 0.0722}}) {
    const Scene scene = import_material(std::string("Pr 1\nmap_Pr ") + option + " i.pfm");
    CAPTURE(option);
    CHECK(scene.warnings.total() == 0);
    CHECK(double(value_of(scene, only(scene).roughness)) == doctest::Approx(value).epsilon(1e-3));
  }
  const Scene holes = import_material("Kd 1 1 1\nmap_d -imfchan g i.pfm");
  CHECK(value_of(holes, only(holes).alpha) == 0.5f);
}

TEST_CASE("MTL: map_Ns is a factor on the exponent") {
  const Scene scene = import_material("illum 2\nKd 1 1 1\nKs 1 1 1\nNs 100\nmap_Ns i.pfm");
  CHECK(scene.warnings.total() == 0);
  CHECK(double(value_of(scene, only(scene).roughness)) == doctest::Approx(std::sqrt(2.0 / 27)));
  CHECK(has_warning(import_material("Kd 1 1 1\nNs 100\nmap_Ns i.pfm"), "map_Ns"));
  // Blender's exporter writes roughness images there.
  const Scene blender = import_material("illum 2\nKs .5 .5 .5\nNs 225\nmap_Ns i.pfm",
                                        "# Blender 3.6.0 MTL File: 'None'\n");
  CHECK(value_of(blender, only(blender).roughness) == 0.25f);
  CHECK(only(blender).roughness_meaning == RoughnessMeaning::alpha_is_square);
  CHECK(has_warning(import_material("Pr .5\nNs 100\nmap_Ns i.pfm"), "map_Ns"));
}

TEST_CASE("MTL: -bm of normal maps, -t, and maps without their numbers") {
  const Scene scene = import_material("Kd 1 1 1\nnorm -bm .5 i.pfm");
  CHECK(only(scene).normal_texture >= 0);
  CHECK(only(scene).normal_scale == 0.5f);
  CHECK(has_warning(import_material("map_Kd -t 1 1 1 i.pfm"), "-t"));
  CHECK(import_material("map_Kd -t 0 0 0 i.pfm").warnings.total() == 0);
  const Scene metal = import_material("Kd 1 1 1\nmap_Pm -imfchan b i.pfm");
  CHECK(only(metal).kind == MaterialKind::metallic_roughness);
  CHECK(value_of(metal, only(metal).metallic) == 1);
}

// A widely used Sponza has such a library.
TEST_CASE("MTL: d 0 of most of a library, or with an image, is not invisible") {
  Scene scene = import_material("Kd 1 1 1\nd 0\nmap_Kd i.pfm");
  CHECK(has_warning(scene, "read as opaque"));
  CHECK(only(scene).kind == MaterialKind::diffuse);
  scene = import_material("Kd 1 1 1\nd 0\nnewmtl b\nd 0\nnewmtl c\nd 1");
  CHECK(has_warning(scene, "read as opaque"));
  CHECK(only(scene).transmission.value == 0);
  scene = import_material("Kd 1 1 1\nd 0\nnewmtl b\nnewmtl c\nd 1");  // a pane
  CHECK(scene.warnings.total() == 0);
  CHECK(only(scene).transmission.value == 1);
  scene = import_material("Kd 1 1 1\nd 1\nTr 1");
  CHECK(only(scene).transmission.value == 0);
}

}  // namespace test_mtl_images
