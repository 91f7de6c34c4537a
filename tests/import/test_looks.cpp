// Tests of properties that several formats express: absorption, bumps, patterns, back faces.
#include <doctest/doctest.h>

#include <cmath>

#include "base/error.h"
#include "image/write_image.h"
#include "import/gltf_builder.h"
#include "import/import.h"
#include "import/mesh/obj.h"
#include "import/temp_folder.h"

using namespace troffer;

namespace test_looks {

namespace {

Scene import_as(const std::string& name, const std::string& text) {
  const TempFolder folder;
  Image image(2, 2);
  image.at(0, 0) = image.at(0, 1) = {1, 1, 1};
  write_image(folder.path("heights.pfm"), image);
  for (int i = 0; i < 4; ++i) image.at(i % 2, i / 2) = {0.5f, 0.5f, 1};
  write_image(folder.path("normals.pfm"), image);
  return import_scene(folder.write(name, text), {});
}

const std::string triangle =
    "Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0] \"point2 uv\" [0 0 1 0 0 1]\n";
Scene pbrt(const std::string& world) {
  return import_as("s.pbrt", "WorldBegin\n" + world);
}
Scene mitsuba(const std::string& shapes) {
  return import_as("s.xml", "<scene version='3.0.0'>" + shapes + "</scene>");
}
const Material& material_of(const Scene& scene) {
  return scene.materials.at(scene.meshes.at(0).material);
}

void check_near(Rgb a, Rgb b) {
  for (size_t c = 0; c < 3; ++c) CHECK(a[c] == doctest::Approx(double(b[c])).epsilon(1e-4));
}

}  // namespace

TEST_CASE("absorption of glass per metre") {
  const auto gltf = [](const std::string& volume) {
    return import_text(square_scene("[{'mesh':0}]",
                                    "'materials':[{'extensions':{'KHR_materials_transmission':{"
                                    "'transmissionFactor':1},'KHR_materials_volume':" +
                                        volume + "}}]"));
  };
  check_near(gltf("{'thicknessFactor':1,'attenuationDistance':0.5,'attenuationColor':[0.5,1,0.1]}")
                 .materials[0]
                 .absorption,
             {1.386294f, 0, 4.60517f});
  CHECK(gltf("{'attenuationDistance':0.5,'attenuationColor':[0.5,1,0.1]}")
            .materials[0]
            .absorption.is_black());  // a sheet
  CHECK(gltf("{'thicknessFactor':1,'attenuationDistance':0,'attenuationColor':[0,1,2]}")
            .warnings.total() > 0);

  const std::string medium =
      "MakeNamedMedium \"m\" \"string type\" \"homogeneous\" \"rgb sigma_a\" [1 2 3] "
      "\"rgb sigma_s\" [0 0 0] \"float scale\" 2\nMediumInterface \"m\" \"\"\n";
  check_near(material_of(pbrt(medium + "Material \"dielectric\"\n" + triangle)).absorption,
             {2, 4, 6});
  CHECK(material_of(pbrt(medium + "Material \"diffuse\"\n" + triangle)).absorption.is_black());
  CHECK(
      material_of(pbrt(medium + "MediumInterface \"\" \"\"\nMaterial \"dielectric\"\n" + triangle))
          .absorption.is_black());
  CHECK_THROWS_AS(pbrt("MediumInterface \"none\" \"\"\n"), InputError);

  check_near(material_of(mitsuba("<shape type='cube'><bsdf type='dielectric'/><medium "
                                 "type='homogeneous' name='interior'><rgb name='sigma_t' "
                                 "value='2,4,6'/><rgb name='albedo' value='.5,0,1'/></medium>"
                                 "</shape>"))
                 .absorption,
             {1, 4, 0});
  const Scene radiance = import_as(
      "s.rad", "void dielectric g 0 0 5 .5 1 .25 1.5 0\ng polygon p 0 0 9 0 0 0 1 0 0 0 1 0\n");
  check_near(material_of(radiance).absorption, {0.693147f, 0, 1.386294f});
}

TEST_CASE("a thin body that absorbs becomes a sheet of its thickness") {
  const std::string medium =
      "MakeNamedMedium \"m\" \"string type\" \"homogeneous\" \"rgb sigma_a\" [1 2 3] "
      "\"rgb sigma_s\" [0 0 0]\nMediumInterface \"m\" \"\"\nMaterial \"dielectric\"\n";
  const auto box = [](const char* z) {
    const std::string t = z;
    return "Shape \"trianglemesh\" \"point3 P\" [0 0 0  1 0 0  1 1 0  0 1 0  0 0 " + t + "  1 0 " +
           t + "  1 1 " + t + "  0 1 " + t +
           "] \"integer indices\" [0 2 1 0 3 2  4 5 6 4 6 7  0 1 5 0 5 4  1 2 6 1 6 5  2 3 7 2 7 6 "
           " 3 0 4 3 4 7]\n";
  };
  const Scene scene = pbrt(medium + box("0.01") + box("0.02"));
  REQUIRE(scene.meshes.size() == 2);
  for (size_t i = 0; i < 2; ++i) {
    const Material& m = scene.materials[scene.meshes[i].material];
    CHECK(m.is_thin);
    const float thickness = i == 0 ? 0.01f : 0.02f;
    check_near(m.absorption, Rgb{1, 2, 3} * thickness);
  }
}

TEST_CASE("bumps") {
  const Scene p = pbrt(
      "Texture \"h\" \"float\" \"imagemap\" \"string filename\" \"heights.pfm\" \"float scale\" "
      "0.02\nMaterial \"diffuse\" \"texture displacement\" \"h\"\n" +
      triangle);
  const Material& m = material_of(p);
  REQUIRE(m.bump.texture >= 0);
  CHECK(evaluate(p.textures, m.bump, Vec2{0.25f, 0.5f}) == doctest::Approx(0.02));
  CHECK(p.warnings.total() == 0);
  const Scene x = mitsuba(
      "<shape type='rectangle'><bsdf type='bumpmap'><texture type='bitmap' name='t'><string "
      "name='filename' value='heights.pfm'/></texture><float name='scale' value='.5'/><bsdf "
      "type='diffuse'/></bsdf></shape>");
  CHECK(material_of(x).bump.texture >= 0);
  CHECK(material_of(x).bump.value == 0.5f);
  CHECK(mitsuba(
            "<shape type='sphere'><bsdf type='bumpmap'><texture type='bitmap'><string "
            "name='filename' value='heights.pfm'/></texture><bsdf type='diffuse'/></bsdf></shape>")
            .spheres.empty());
  const auto obj = [](const std::string& line) {
    const TempFolder folder;
    Image image(2, 2);
    write_image(folder.path("heights.pfm"), image);
    for (int i = 0; i < 4; ++i) image.at(i % 2, i / 2) = {0.5f, 0.5f, 1};
    write_image(folder.path("normals.pfm"), image);
    folder.write("m.mtl", "newmtl a\n" + line + "\n");
    return import_obj(
        folder.write("m.obj",
                     "mtllib m.mtl\nusemtl a\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\n"
                     "f 1/1 2/2 3/3\n"));
  };
  const Scene heights = obj("map_Bump -bm 3 heights.pfm");
  CHECK(material_of(heights).bump.texture >= 0);
  CHECK(material_of(heights).bump.value == doctest::Approx(0.03));
  const Scene normals = obj("map_Bump -bm 0.5 normals.pfm");
  CHECK(material_of(normals).bump.texture < 0);
  CHECK(material_of(normals).normal_texture >= 0);
  CHECK(material_of(normals).normal_scale == 0.5f);
}

TEST_CASE("pbrt's patterns and noise are evaluated with the transform of their definition") {
  const auto value = [](const std::string& texture, const TexturePlace& place) {
    const Scene s = pbrt("Translate 1 0 0\n" + texture +
                         "\nMaterial \"diffuse\" \"texture reflectance\" \"t\"\n" + triangle);
    return evaluate(s.textures, material_of(s).base_color, place);
  };
  const auto at = [](float x, float y, float z) {
    TexturePlace p;
    p.position = {x, y, z};
    return p;
  };
  const std::string solid =
      "Texture \"t\" \"spectrum\" \"checkerboard\" \"integer dimension\" 3 \"rgb tex1\" [1 0 0] "
      "\"rgb tex2\" [0 0 1]";
  CHECK(value(solid, at(1.5f, 0.5f, 0.5f)) == Rgb{1, 0, 0});
  CHECK(value(solid, at(0.5f, 0.5f, 0.5f)) == Rgb{0, 0, 1});
  const std::string planar =
      "Texture \"t\" \"spectrum\" \"checkerboard\" \"string mapping\" \"planar\" \"vector3 v1\" "
      "[0 0 1] \"rgb tex1\" [1 0 0] \"rgb tex2\" [0 0 1]";
  CHECK(value(planar, at(9, 0.5f, 0.5f)) == Rgb{1, 0, 0});
  CHECK(value(planar, at(9, 0.5f, 1.5f)) == Rgb{0, 0, 1});
  const std::string mixed =
      "Texture \"a\" \"float\" \"checkerboard\" \"float tex1\" 1 \"float tex2\" 0\n"
      "Texture \"t\" \"spectrum\" \"mix\" \"texture amount\" \"a\" \"rgb tex1\" [1 0 0] "
      "\"rgb tex2\" [0 0 1]";
  CHECK(value(mixed, Vec2{0.5f, 0.5f}) == Rgb{0, 0, 1});
  CHECK(value(mixed, Vec2{1.5f, 0.5f}) == Rgb{1, 0, 0});
  for (const char* kind : {"fbm", "wrinkled", "windy"}) {
    const std::string t = "Texture \"n\" \"float\" \"" + std::string(kind) +
                          "\"\nTexture \"t\" \"spectrum\" \"mix\" \"texture amount\" \"n\"";
    CHECK(value(t, at(3.3f, 0.7f, 2.4f)) != value(t, at(5.9f, 4.1f, 8.8f)));
  }
}

TEST_CASE("round shapes of pbrt with textures or holes are triangles, those that emit are exact") {
  const auto spheres = [](const std::string& what) { return pbrt(what).spheres.size(); };
  const std::string checks =
      "Texture \"t\" \"spectrum\" \"checkerboard\"\nMaterial \"diffuse\" \"texture reflectance\" "
      "\"t\"\n";
  CHECK(spheres("Shape \"sphere\"\n") == 1);
  CHECK(spheres(checks + "Shape \"sphere\"\n") == 0);
  CHECK(spheres("Shape \"sphere\" \"float alpha\" .3\n") == 0);
  CHECK(spheres(checks + "AreaLightSource \"diffuse\"\nShape \"sphere\"\n") == 1);
  CHECK(pbrt(checks + "Shape \"disk\"\n").disks.empty());
  CHECK_FALSE(pbrt(checks + "Shape \"disk\"\n").meshes.at(0).uvs.empty());
}

TEST_CASE("visibility of back sides, by format") {
  const auto gltf = [](const std::string& material) {
    return import_text(square_scene("[{'mesh':0}]", "'materials':[" + material + "]"))
        .materials[0]
        .back_faces;
  };
  CHECK(gltf("{}") == BackFaces::unseen);
  CHECK(gltf("{'doubleSided':true}") == BackFaces::shown);
  CHECK(gltf("{'emissiveFactor':[1,1,1]}") == BackFaces::shown);
  const auto xml = [](const std::string& bsdf) {
    return material_of(mitsuba("<shape type='rectangle'>" + bsdf + "</shape>")).back_faces;
  };
  CHECK(xml("") == BackFaces::black);
  CHECK(xml("<bsdf type='diffuse'/>") == BackFaces::black);
  CHECK(xml("<bsdf type='twosided'><bsdf type='plastic'/></bsdf>") == BackFaces::shown);
  CHECK(xml("<bsdf type='dielectric'/>") == BackFaces::shown);
  CHECK(
      xml("<bsdf type='mask'><float name='opacity' value='.7'/><bsdf type='conductor'/></bsdf>") ==
      BackFaces::black);
}

}  // namespace test_looks
