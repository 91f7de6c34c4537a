// Tests of Mitsuba's bsdfs that contain others: blends, mixtures, coats, bumps; and of rotated
// textures.
#include <doctest/doctest.h>

#include <cmath>
#include <string>

#include "base/error.h"
#include "base/units.h"
#include "import/mitsuba/mitsuba.h"
#include "scene_checks.h"
#include "temp_folder.h"

using namespace troffer;

namespace test_mitsuba_mixed {

namespace {

Scene import_bsdf(const std::string& bsdf) {
  const TempFolder folder;
  return import_mitsuba(folder.write(
      "scene.xml", "<scene version='3.0.0'><shape type='rectangle'>" + bsdf + "</shape></scene>"));
}
Material material_of(const std::string& bsdf) {
  const Scene scene = import_bsdf(bsdf);
  REQUIRE(scene.materials.size() == 1);
  return scene.materials[0];
}

std::string diffuse(const std::string& value) {
  return "<bsdf type='diffuse'><rgb name='reflectance' value='" + value + "'/></bsdf>";
}
std::string checks(const std::string& name) {
  return "<texture type='checkerboard' name='" + name +
         "'><rgb name='color0' value='1'/><rgb name='color1' value='0'/></texture>";
}
std::string mixture(const std::string& weights, const std::string& bsdfs) {
  return "<bsdf type='mixturebsdf'><string name='weights' value='" + weights + "'/>" + bsdfs +
         "</bsdf>";
}

}  // namespace

TEST_CASE("mixtures have as many parts as weights; the rest to 1 is absorbed") {
  Material m = material_of(mixture("1, .5, .5", diffuse(".8") + diffuse(".4") + diffuse("0")));
  CHECK(m.base_color.value.r == doctest::Approx(0.5));  // weights that add up to 2 are normalised
  m = material_of(mixture(".5 .3", diffuse("1 0 0") +
                                       "<bsdf type='difftrans'><rgb name='transmittance' value='0 "
                                       "1 0'/></bsdf>"));
  CHECK(m.base_color.value == Rgb{0.5f, 0, 0});
  CHECK(m.diffuse_transmission.value == 1);
  CHECK(m.diffuse_transmission_color.value == Rgb{0, 0.3f, 0});
  CHECK(import_bsdf(mixture(".5 .3", diffuse("1") + diffuse("1"))).warnings.total() == 0);
  CHECK_THROWS_AS(import_bsdf(mixture("1", diffuse("1") + diffuse("1"))), InputError);
  CHECK_THROWS_AS(import_bsdf(mixture("1 -1", diffuse("1") + diffuse("1"))), InputError);
  const Scene metal =
      import_bsdf(mixture(".2 .5 .3", diffuse("1") + "<bsdf type='conductor'/>" + diffuse("1")));
  CHECK(has_warning(metal, "larger weight"));
  CHECK(metal.materials.at(0).kind == MaterialKind::conductor);
}

TEST_CASE("a share of null lets that share of light through") {
  const std::string bsdfs = "<bsdf type='null'/>" + diffuse(".6");
  Scene scene =
      import_bsdf("<bsdf type='blendbsdf'><float name='weight' value='.3'/>" + bsdfs + "</bsdf>");
  CHECK(scene.warnings.total() == 0);
  const Material& veil = scene.materials.at(0);
  CHECK(coverage({}, veil, Vec2{0, 0}) == doctest::Approx(0.3));
  CHECK(veil.base_color.value.r == 0.6f);
  scene = import_bsdf("<bsdf type='blendbsdf'>" + checks("weight") + diffuse(".6") +
                      "<bsdf type='null'/></bsdf>");
  CHECK(scene.warnings.total() == 0);
  CHECK_FALSE(is_cut_out(scene.textures, scene.materials.at(0), Vec2{0.2f, 0.2f}));
  CHECK(is_cut_out(scene.textures, scene.materials.at(0), Vec2{0.7f, 0.2f}));
}

TEST_CASE("diffuse blends by textures are textures") {
  const Scene scene = import_bsdf("<bsdf type='blendbsdf'>" + checks("weight") + diffuse(".2") +
                                  diffuse(".8") + "</bsdf>");
  CHECK(scene.warnings.total() == 0);
  const ColorInput& c = scene.materials.at(0).base_color;
  CHECK(evaluate(scene.textures, c, Vec2{0.2f, 0.2f}).r == doctest::Approx(0.2));
  CHECK(evaluate(scene.textures, c, Vec2{0.7f, 0.2f}).r == doctest::Approx(0.8));
  const Scene half =
      import_bsdf("<bsdf type='blendbsdf'><float name='weight' value='.5'/>" + diffuse(".2") +
                  "<bsdf type='diffuse'>" + checks("reflectance") + "</bsdf></bsdf>");
  CHECK(half.warnings.total() == 0);
  const ColorInput& d = half.materials.at(0).base_color;
  CHECK(evaluate(half.textures, d, Vec2{0.2f, 0.2f}).r == doctest::Approx(0.6));
  CHECK(evaluate(half.textures, d, Vec2{0.7f, 0.2f}).r == doctest::Approx(0.1));
}

TEST_CASE("a textured blend of different materials becomes the one with more weight") {
  const Scene scene = import_bsdf(
      "<bsdf type='blendbsdf'><texture type='checkerboard' name='weight'><rgb "
      "name='color0' value='1'/><rgb name='color1' value='.4'/></texture>" +
      diffuse(".2") + "<bsdf type='conductor'/></bsdf>");
  CHECK(scene.materials.at(0).kind == MaterialKind::conductor);
  CHECK(has_warning(scene, "larger weight"));
}

TEST_CASE("masks within masks, and coats that absorb") {
  const std::string mask =
      "<bsdf type='mask'><float name='opacity' value='.5'/><bsdf type='mask'><float "
      "name='opacity' value='.5'/>" +
      diffuse(".5") + "</bsdf></bsdf>";
  CHECK(coverage({}, material_of(mask), Vec2{0, 0}) == 0.25f);
  const auto coat = [](const char* absorbed) {
    return import_bsdf(std::string("<bsdf type='coating'><float name='thickness' value='2'/><rgb "
                                   "name='sigma_a' value='") +
                       absorbed + "'/><bsdf type='twosided'>" + diffuse(".5") + "</bsdf></bsdf>");
  };
  CHECK(coat("0").warnings.total() == 0);
  CHECK(coat("0").materials.at(0).kind == MaterialKind::coated_diffuse);
  CHECK(coat("0").materials.at(0).base_color.value.r == 0.5f);
  const Scene dark = coat(".1 .2 3");
  CHECK(has_warning(dark, "absorption"));
  // Between normal passage and the longest one, at the critical angle.
  const Rgb kept = dark.materials.at(0).base_color.value * 2;
  CHECK(double(kept.r) < std::exp(-0.4));
  CHECK(double(kept.r) > std::exp(-0.4 * 1.35));
  CHECK(kept.b < 1e-4f);
  const Scene glass = import_bsdf(
      "<bsdf type='coating'><float name='int_ior' value='1.4'/><rgb name='sigma_a' value='.1'/>"
      "<bsdf type='thindielectric'/></bsdf>");
  CHECK(has_warning(glass, "without refraction"));
  CHECK(glass.materials.at(0).kind == MaterialKind::dielectric);
  CHECK(glass.materials.at(0).coat.value == 1);
  CHECK(glass.materials.at(0).coat_ior == doctest::Approx(1.4).epsilon(1e-3));
  CHECK(double(glass.materials.at(0).base_color.value.r) == doctest::Approx(std::exp(-0.2)));
}

TEST_CASE("bumps by a texture of heights that is scaled") {
  const TempFolder folder;
  std::string pfm = "Pf\n1 1\n-1.0\n";
  const float one = 1;
  pfm.append(reinterpret_cast<const char*>(&one), sizeof one);
  folder.write("t.pfm", pfm);
  const Scene scene = import_mitsuba(folder.write(
      "s.xml",
      "<scene version='0.6.0'><shape type='rectangle'><bsdf type='bumpmap'><texture type='scale'>"
      "<float name='scale' value='10'/><texture type='bitmap'><string name='filename' "
      "value='t.pfm'/></texture></texture><bsdf type='diffuse'/></bsdf></shape></scene>"));
  CHECK(scene.warnings.total() == 0);
  const FloatInput& bump = scene.materials.at(0).bump;
  CHECK(bump.texture >= 0);
  CHECK(bump.value == 10);
}

TEST_CASE("a texture's to_uv may turn") {
  const Scene scene = import_bsdf(
      "<bsdf type='diffuse'><texture type='checkerboard' name='reflectance'><rgb name='color0' "
      "value='1'/><rgb name='color1' value='0'/><transform name='to_uv'><scale x='2' y='-3'/>"
      "<rotate z='1' angle='30'/><translate x='.1' y='.2'/></transform></texture></bsdf>");
  CHECK(scene.warnings.total() == 0);
  const ColorInput& c = scene.materials.at(0).base_color;
  const double angle = std::acos(-1.0) / 6;
  for (const float u : {0.13f, 0.37f, 0.71f})
    for (const float v : {0.21f, 0.55f, 0.93f}) {
      const double a = 2 * double(u), b = -3 * double(v);
      const double x = std::cos(angle) * a - std::sin(angle) * b + 0.1;
      const double y = std::sin(angle) * a + std::cos(angle) * b + 0.2;
      const bool is_first = (x - std::floor(x) < 0.5) == (y - std::floor(y) < 0.5);
      CAPTURE(u);
      CAPTURE(v);
      CHECK(evaluate(scene.textures, c, Vec2{u, v}).r == (is_first ? 1 : 0));
    }
}

// Values as Blender's exporter writes them.
TEST_CASE("principled: zero values cause no warning, anisotropy is supported") {
  const auto principled = [](const char* anisotropic, const char* sheen) {
    return import_bsdf(std::string("<bsdf type='principled'><float name='roughness' value='.6'/>"
                                   "<rgb value='0.000000 0.000000 0.000000' name='spec_tint'/>"
                                   "<float name='anisotropic' value='") +
                       anisotropic + "'/><float name='sheen' value='" + sheen +
                       "'/><rgb value='1.000000 1.000000 1.000000' name='sheen_tint'/></bsdf>");
  };
  const Scene plain = principled("0.000000", "0.000000");
  CHECK_FALSE(has_warning(plain, "without"));
  CHECK_FALSE(has_warning(plain, "not used"));
  CHECK(plain.materials.at(0).anisotropy.value == 0);
  CHECK(has_warning(principled("0", ".5"), "without sheen, sheen_tint"));
  // Widths of r² / a and r² a, a = sqrt(1 - .9 anisotropic).
  const Material m = principled(".5", "0").materials.at(0);
  const double aspect = std::sqrt(1 - 0.45), across = 0.36 * aspect, along = 0.36 / aspect;
  CHECK(double(sqr(m.roughness.value)) == doctest::Approx(across));
  CHECK(across + (1 - across) * double(sqr(m.anisotropy.value)) == doctest::Approx(along));
}

}  // namespace test_mitsuba_mixed
