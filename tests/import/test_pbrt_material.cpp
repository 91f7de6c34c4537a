// Tests of materials, textures and spectra of pbrt scenes.
#include <doctest/doctest.h>

#include <cmath>
#include <string>

#include "base/error.h"
#include "base/units.h"
#include "image/write_image.h"
#include "import/pbrt/pbrt.h"
#include "import/spectra.h"
#include "scene_checks.h"
#include "temp_folder.h"

using namespace troffer;

namespace test_pbrt_material {

namespace {

const std::string triangle = "Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0]\n";

Scene import_world(const std::string& world) {
  const TempFolder folder;
  // Two rows of two texels: red, green / blue, white.
  Image image(2, 2);
  image.at(0, 0) = {1, 0, 0};
  image.at(1, 0) = {0, 1, 0};
  image.at(0, 1) = {0, 0, 1};
  image.at(1, 1) = {1, 1, 1};
  write_image(folder.path("four.pfm"), image);
  folder.write("flat.spd", "# a comment\n400 0.25\n700 0.25\n");
  return import_pbrt(folder.write("scene.pbrt", "WorldBegin\n" + world));
}

Material material_of(const std::string& material) {
  const Scene scene = import_world(material + "\n" + triangle);
  return scene.materials.at(scene.meshes.at(0).material);
}

void check_near(Rgb a, Rgb b, float tolerance = 1e-4f) {
  CHECK(std::abs(a.r - b.r) <= tolerance);
  CHECK(std::abs(a.g - b.g) <= tolerance);
  CHECK(std::abs(a.b - b.b) <= tolerance);
}

// Returns the base colour of the only mesh's material at (u,v).
Rgb color_at(const Scene& scene, Vec2 uv) {
  return evaluate(scene.textures, scene.materials.at(scene.meshes.at(0).material).base_color, uv);
}

}  // namespace

TEST_CASE("pbrt materials and their defaults") {
  Material m = material_of("");
  CHECK(m.kind == MaterialKind::diffuse);
  CHECK(m.base_color.value == Rgb(0.5f));

  m = material_of("Material \"coateddiffuse\"");
  CHECK(m.kind == MaterialKind::coated_diffuse);
  CHECK(m.base_color.value == Rgb(0.5f));
  CHECK(m.roughness.value == 0);
  CHECK(m.roughness_meaning == RoughnessMeaning::alpha_is_sqrt);
  CHECK(m.ior == 1.5f);

  m = material_of(
      "Material \"coateddiffuse\" \"float roughness\" .3 \"bool remaproughness\" false "
      "\"float eta\" 1.4 \"float thickness\" .02");
  CHECK(m.roughness.value == 0.3f);
  CHECK(m.roughness_meaning == RoughnessMeaning::alpha);
  CHECK(m.ior == 1.4f);

  m = material_of("Material \"conductor\"");
  CHECK(m.kind == MaterialKind::conductor);
  CHECK_FALSE(m.is_reflectance);
  CHECK(m.eta.r < m.eta.g);  // copper

  m = material_of(
      "Material \"conductor\" \"spectrum eta\" \"metal-Au-eta\" \"spectrum k\" "
      "\"metal-Au-k\" \"float uroughness\" .1 \"float vroughness\" .4");
  CHECK(m.eta.b == doctest::Approx(1.442479));
  CHECK(m.k.r == doctest::Approx(3.98316));
  // widths sqrt(.1) along u, sqrt(.4) along v
  CHECK(m.roughness.value == doctest::Approx(0.1));
  const auto alpha = std::sqrt(0.1f);
  CHECK(alpha + (1 - alpha) * sqr(m.anisotropy.value) == doctest::Approx(std::sqrt(0.4f)));
  CHECK(m.anisotropy_rotation_rad == doctest::Approx(pi / 2));

  m = material_of("Material \"conductor\" \"rgb reflectance\" [.9 .8 .7]");
  CHECK(m.is_reflectance);
  CHECK(m.base_color.value == Rgb(0.9f, 0.8f, 0.7f));

  m = material_of("Material \"dielectric\" \"spectrum eta\" \"glass-BK7\"");
  CHECK(m.kind == MaterialKind::dielectric);
  CHECK(m.ior == doctest::Approx(1.5168));
  CHECK_FALSE(m.is_thin);

  m = material_of("Material \"thindielectric\" \"float eta\" 1.3");
  CHECK(m.is_thin);
  CHECK(m.ior == 1.3f);

  m = material_of(
      "MakeNamedMaterial \"a\" \"string type\" \"diffuse\" \"rgb reflectance\" [.1 .2 "
      ".3]\nNamedMaterial \"a\"");
  CHECK(m.name == "a");
  CHECK(m.base_color.value == Rgb(0.1f, 0.2f, 0.3f));
}

TEST_CASE("unsupported materials are shown diffuse, and say so") {
  const Scene scene = import_world("Material \"hair\" \"float beta_m\" .3\n" + triangle +
                                   "Material \"subsurface\" \"rgb reflectance\" [1 0 0]\n" +
                                   triangle + "Material \"interface\"\n" + triangle);
  CHECK(has_warning(scene, "\"hair\""));
  CHECK(has_warning(scene, "\"subsurface\""));
  CHECK(has_warning(scene, "interface"));
  CHECK(scene.warnings.entries().size() == 3);
  REQUIRE(scene.meshes.size() == 2);
  const Material& skin = scene.materials[scene.meshes[1].material];
  CHECK(skin.kind == MaterialKind::coated_diffuse);
  CHECK(skin.base_color.value == Rgb(1, 0, 0));
  CHECK(skin.ior == 1.33f);
}

TEST_CASE("scattering in a coat causes a warning") {
  for (const std::string name : {"coateddiffuse", "coatedconductor"}) {
    const std::string material = "Material \"" + name + "\" ";
    CHECK(has_warning(import_world(material + "\"rgb albedo\" [.5 .5 .5]\n" + triangle),
                      name + "\": the medium in the coat"));
    CHECK(import_world(material + "\"float thickness\" .2\n" + triangle).warnings.total() == 0);
  }
}

TEST_CASE("mixes by textures, and of textures") {
  const std::string image =
      "Texture \"t\" \"spectrum\" \"imagemap\" \"string filename\" \"four.pfm\" \"string filter\" "
      "\"point\"\nTexture \"f\" \"float\" \"imagemap\" \"string filename\" \"four.pfm\" \"string "
      "filter\" \"point\"\n";
  const std::string named =
      "MakeNamedMaterial \"a\" \"string type\" \"diffuse\" \"texture reflectance\" \"t\"\n"
      "MakeNamedMaterial \"b\" \"string type\" \"diffuse\" \"rgb reflectance\" [0 0 .5]\n"
      "MakeNamedMaterial \"m\" \"string type\" \"conductor\"\n";
  const auto mix = [&](const std::string& names, const std::string& amount) {
    return import_world(image + named + "Material \"mix\" \"string materials\" [" + names + "] " +
                        amount + "\n" + triangle);
  };
  Scene scene = mix("\"a\" \"b\"", "\"float amount\" .25");
  CHECK(scene.warnings.total() == 0);
  check_near(color_at(scene, {0.25f, 0.75f}), {0.75f, 0, 0.125f});  // red above
  scene = mix("\"a\" \"b\"", "\"texture amount\" \"f\"");
  CHECK(scene.warnings.total() == 0);
  check_near(color_at(scene, {0.75f, 0.25f}), {0, 0, 0.5f});  // where the share is 1
  // Different kinds are replaced by the one of more weight: the texture's mean is a half.
  scene = mix("\"a\" \"m\"", "\"texture amount\" \"f\"");
  CHECK(has_warning(scene, "larger weight"));
  CHECK(scene.materials.at(scene.meshes.at(0).material).kind == MaterialKind::conductor);
  scene = import_world(image +
                       "Texture \"d\" \"spectrum\" \"directionmix\" \"texture tex1\" \"t\" \"rgb "
                       "tex2\" [0 0 1] \"vector3 dir\" [0 1 0]\nMaterial \"diffuse\" \"texture "
                       "reflectance\" \"d\"\n" +
                       triangle);
  CHECK(has_warning(scene, "half of each"));
  check_near(color_at(scene, {0.25f, 0.75f}), {0.5f, 0, 0.5f});
}

TEST_CASE("impossible values of a material are errors") {
  CHECK_THROWS_AS(material_of("Material \"dielectric\" \"float eta\" 0"), InputError);
  CHECK_THROWS_AS(material_of("Material \"diffuse\" \"texture reflectance\" \"none\""), InputError);
  CHECK_THROWS_AS(material_of("Material \"diffuse\" \"blackbody reflectance\" 3000"), InputError);
  CHECK_THROWS_AS(material_of("Material \"diffuse\" \"rgb reflectance\" [1 2 3 4 5 6]"),
                  InputError);
  CHECK_THROWS_AS(material_of("Material \"diffuse\" \"spectrum reflectance\" [500 1 400 1]"),
                  InputError);
  CHECK_THROWS_AS(material_of("Material \"diffuse\" \"spectrum reflectance\" \"no-such\""),
                  InputError);
  CHECK(material_of("Material \"diffuse\" \"rgb reflectance\" [2 1 -1]").base_color.value ==
        Rgb(1, 1, 0));
}

TEST_CASE("an imagemap has (0,0) at its lower left") {
  const Scene scene = import_world(
      "Texture \"t\" \"spectrum\" \"imagemap\" \"string filename\" \"four.pfm\" \"string filter\" "
      "\"point\"\nMaterial \"diffuse\" \"texture reflectance\" \"t\"\n" +
      triangle);
  CHECK(color_at(scene, {0.25f, 0.25f}) == Rgb(0, 0, 1));
  CHECK(color_at(scene, {0.75f, 0.25f}) == Rgb(1, 1, 1));
  CHECK(color_at(scene, {0.25f, 0.75f}) == Rgb(1, 0, 0));
  CHECK(color_at(scene, {1.75f, 0.75f}) == Rgb(0, 1, 0));  // repeats
  // Without coordinates each triangle spans (0,0) (1,0) (1,1).
  CHECK(scene.meshes[0].uvs.at(1) == Vec2(1, 0));
  CHECK(scene.meshes[0].uvs.at(2) == Vec2(1, 1));
}

TEST_CASE("imagemap parameters") {
  const Scene scene = import_world(
      "Texture \"t\" \"spectrum\" \"imagemap\" \"string filename\" \"four.pfm\" \"string filter\" "
      "\"point\" \"float uscale\" 2 \"float vdelta\" .5 \"float scale\" .5 \"string wrap\" "
      "\"black\"\nMaterial \"diffuse\" \"texture reflectance\" \"t\"\n" +
      triangle);
  // (u,v) -> (2 u, v + .5)
  CHECK(color_at(scene, {0.2f, 0.1f}) == Rgb(0.5f, 0, 0));
  CHECK(color_at(scene, {0.4f, 0.1f}) == Rgb(0, 0.5f, 0));
  CHECK(color_at(scene, {0.4f, 0.6f}) == Rgb(0, 0, 0));
  CHECK(scene.warnings.entries().empty());

  const Scene missing = import_world(
      "Texture \"t\" \"spectrum\" \"imagemap\" \"string filename\" \"gone.png\"\n"
      "Material \"diffuse\" \"texture reflectance\" \"t\"\n" +
      triangle);
  CHECK(has_warning(missing, "gone.png"));
  CHECK(color_at(missing, {0, 0}) == Rgb(0.5f));  // grey
}

TEST_CASE("constant and scaled textures, with images and without") {
  const std::string textures =
      "Texture \"c\" \"spectrum\" \"constant\" \"rgb value\" [.2 .4 .8]\n"
      "Texture \"f\" \"float\" \"constant\" \"float value\" .5\n"
      "Texture \"i\" \"spectrum\" \"imagemap\" \"string filename\" \"four.pfm\" \"string filter\" "
      "\"point\"\n"
      "Texture \"g\" \"float\" \"imagemap\" \"string filename\" \"four.pfm\" \"string filter\" "
      "\"point\"\n"
      "Texture \"cf\" \"spectrum\" \"scale\" \"texture tex\" \"c\" \"texture scale\" \"f\"\n"
      "Texture \"i2\" \"spectrum\" \"scale\" \"texture tex\" \"i\" \"float scale\" .25\n"
      "Texture \"ig\" \"spectrum\" \"scale\" \"texture tex\" \"i\" \"texture scale\" \"g\"\n";
  const auto scene_with = [&](const std::string& name) {
    return import_world(textures + "Material \"diffuse\" \"texture reflectance\" \"" + name +
                        "\"\n" + triangle);
  };
  check_near(color_at(scene_with("cf"), {0, 0}), {0.1f, 0.2f, 0.4f});
  check_near(color_at(scene_with("i2"), {0.25f, 0.25f}), {0, 0, 0.25f});
  // The float image is the mean of the channels: a third at each coloured texel.
  const Scene product = scene_with("ig");
  check_near(color_at(product, {0.25f, 0.25f}), {0, 0, 1 / 3.0f});
  check_near(color_at(product, {0.75f, 0.25f}), {1, 1, 1});
  CHECK(product.warnings.entries().empty());

  const Scene rough = import_world(
      textures + "Material \"coateddiffuse\" \"texture roughness\" \"g\"\n" + triangle);
  const Material& m = rough.materials.at(rough.meshes.at(0).material);
  CHECK(evaluate(rough.textures, m.roughness, Vec2{0.25f, 0.75f}) == doctest::Approx(1 / 3.0));
}

TEST_CASE("impossible textures are errors") {
  CHECK_THROWS_AS(import_world("Texture \"a\" \"float\" \"scale\" \"texture tex\" \"a\"\n"
                               "Material \"coateddiffuse\" \"texture roughness\" \"a\"\n" +
                               triangle),
                  InputError);
  // A tower of products whose look-up would read 2^30 images.
  std::string tower = "Texture \"t0\" \"float\" \"imagemap\" \"string filename\" \"four.pfm\"\n";
  for (int i = 0; i < 30; ++i)
    tower += "Texture \"t" + std::to_string(i + 1) + "\" \"float\" \"scale\" \"texture tex\" \"t" +
             std::to_string(i) + "\" \"texture scale\" \"t" + std::to_string(i) + "\"\n";
  CHECK_THROWS_AS(
      import_world(tower + "Material \"coateddiffuse\" \"texture roughness\" \"t30\"\n" + triangle),
      InputError);
  // A chain too long to follow.
  std::string chain = "Texture \"t0\" \"float\" \"constant\"\n";
  for (int i = 0; i < 5000; ++i)
    chain += "Texture \"t" + std::to_string(i + 1) + "\" \"float\" \"scale\" \"texture tex\" \"t" +
             std::to_string(i) + "\"\n";
  CHECK_THROWS_AS(
      import_world(chain + "Material \"coateddiffuse\" \"texture roughness\" \"t5000\"\n" +
                   triangle),
      InputError);
}

TEST_CASE("alpha textures cut holes; constant alpha 0 removes the shape") {
  const Scene scene = import_world(
      "Texture \"a\" \"float\" \"imagemap\" \"string filename\" \"four.pfm\"\n"
      "Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0] \"texture alpha\" \"a\"\n"
      "Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0] \"float alpha\" 0\n" +
      triangle);
  REQUIRE(scene.meshes.size() == 2);
  const Material& masked = scene.materials.at(scene.meshes[0].material);
  CHECK(masked.is_alpha_masked);
  CHECK(masked.alpha.texture >= 0);
  CHECK_FALSE(scene.materials.at(scene.meshes[1].material).is_alpha_masked);
}

TEST_CASE("a light of alpha 0 shines") {
  const Scene scene = import_world(
      "AttributeBegin\nAreaLightSource \"diffuse\" \"rgb L\" [1 2 3]\nShape \"sphere\" \"float "
      "alpha\" "
      "0\nAttributeEnd\nShape \"sphere\" \"float alpha\" 0\n");
  REQUIRE(scene.lights.size() == 1);
  CHECK(scene.spheres.size() == 1);
  CHECK(scene.lights[0].radiance == Rgb(1, 2, 3));
  CHECK(has_warning(scene, "light of constant alpha 0"));
  CHECK(has_warning(scene, "left out"));
}

TEST_CASE("one material under alpha textures of different factors") {
  const std::string shape = "Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0] ";
  const Scene scene = import_world(
      "Texture \"a\" \"float\" \"imagemap\" \"string filename\" \"four.pfm\"\n"
      "Texture \"b\" \"float\" \"scale\" \"texture tex\" \"a\" \"float scale\" 0.25\n" +
      shape + "\"texture alpha\" \"a\"\n" + shape + "\"texture alpha\" \"b\"\n" + shape +
      "\"texture alpha\" \"a\"\n");
  REQUIRE(scene.meshes.size() == 3);
  CHECK(scene.materials.at(scene.meshes[0].material).alpha.value == 1);
  CHECK(scene.materials.at(scene.meshes[1].material).alpha.value == 0.25f);
  CHECK(scene.meshes[0].material == scene.meshes[2].material);
}

TEST_CASE("images of emission belong to meshes") {
  const Scene scene = import_world(
      "AreaLightSource \"diffuse\" \"string filename\" \"four.pfm\" \"float scale\" 3\n" +
      triangle + "Shape \"sphere\"");
  REQUIRE(scene.lights.size() == 2);
  const Light& e = scene.lights[0];
  CHECK(e.kind == LightKind::mesh);
  CHECK(e.radiance == Rgb(3));
  REQUIRE(e.texture >= 0);
  check_near(emitted_radiance(scene, e, true, Vec2{0.25f, 0.25f}), {0, 0, 3});
  CHECK(scene.lights[1].texture == no_texture);
  CHECK(has_warning(scene, "emission of a sphere"));
}

TEST_CASE("spectra in linear sRGB") {
  check_near(
      material_of("Material \"diffuse\" \"spectrum reflectance\" \"flat.spd\"").base_color.value,
      Rgb(0.25f), 0.01f);
  check_near(reflectance_from_spectrum({{360, 830}, {0.7, 0.7}}), Rgb(0.7f));
  // A narrow band of red light.
  const Rgb red = reflectance_from_spectrum({{600, 610, 700, 710}, {0, 1, 1, 0}});
  CHECK(red.r > 0.5f);
  CHECK(red.g < 0.1f);
  CHECK(red.b < 0.01f);
  // Chromaticities: 2856 K is illuminant A, 6504 K is close to D65 (daylight is slightly greener).
  check_near(blackbody_emission(2856), *named_illuminant("stdillum-A"), 0.03f);
  check_near(blackbody_emission(6504), Rgb(1), 0.06f);
  for (const double kelvin : {500.0, 1000.0, 2700.0, 6500.0, 20000.0, 1e6})
    CHECK(luminance(blackbody_emission(kelvin)) == doctest::Approx(1).epsilon(1e-5));
  check_near(*named_illuminant("stdillum-D65"), Rgb(1), 2e-3f);
  CHECK_FALSE(named_illuminant("stdillum-X").has_value());
  CHECK(named_metal("metal-CuZn-k")->r == doctest::Approx(3.695));
  // Chromium reflects two thirds, tungsten half.
  for (const auto& [metal, reflectance] : {std::pair{"Cr", 0.67}, {"W", 0.5}}) {
    const std::string name = std::string("metal-") + metal;
    const Rgb n = *named_metal(name + "-eta"), k = *named_metal(name + "-k");
    const Rgb below = n - Rgb{1}, above = n + Rgb{1};
    const Rgb r = (below * below + k * k) / (above * above + k * k);
    CHECK(double(average(r)) == doctest::Approx(reflectance).epsilon(0.03));
  }
  CHECK_FALSE(named_metal("metal-Xx-k").has_value());
  CHECK(*named_glass("glass-SF11") == doctest::Approx(1.7847));
  const SampledSpectrum ramp{{400, 700}, {0, 3}};
  CHECK(value_at(ramp, 500) == doctest::Approx(1));
  CHECK(value_at(ramp, 399) == 0);
  CHECK(value_at(ramp, 700) == doctest::Approx(3));
}

}  // namespace test_pbrt_material
