// Tests of glTF materials and textures.
#include <doctest/doctest.h>

#include <cmath>

#include "import/gltf_builder.h"
#include "import/thin_glass.h"

using namespace troffer;

namespace test_gltf_material {

namespace {

Scene with_material(const std::string& material, const std::string& more = "") {
  return import_text(square_scene("[{'mesh':0}]", "'materials':[" + material + "]" + more));
}
const Material& only_material(const Scene& scene) {
  REQUIRE(scene.materials.size() == 1);
  return scene.materials[0];
}

}  // namespace

TEST_CASE("the default material is a rough white metal, as glTF says") {
  const Scene scene = with_material("{}");
  const Material& m = only_material(scene);
  CHECK(m.kind == MaterialKind::metallic_roughness);
  CHECK(m.roughness_meaning == RoughnessMeaning::alpha_is_square);
  CHECK(m.base_color.value == Rgb{1});
  CHECK(m.metallic.value == 1);
  CHECK(m.roughness.value == 1);
  CHECK(m.ior == 1.5f);
}

TEST_CASE("factors of metallic-roughness, specular, ior, transmission and volume") {
  const Scene scene = with_material(
      "{'name':'m','pbrMetallicRoughness':{'baseColorFactor':[0.1,0.2,0.3,0.4],"
      "'metallicFactor':0.25,'roughnessFactor':0.75},'extensions':{"
      "'KHR_materials_specular':{'specularFactor':0.5,'specularColorFactor':[1,2,3]},"
      "'KHR_materials_ior':{'ior':1.3},'KHR_materials_transmission':{'transmissionFactor':0.9},"
      "'KHR_materials_volume':{'thicknessFactor':0.1}}}");
  const Material& m = only_material(scene);
  CHECK(m.name == "m");
  CHECK(m.base_color.value == Rgb{0.1f, 0.2f, 0.3f});
  CHECK_FALSE(m.is_alpha_masked);
  CHECK(m.metallic.value == 0.25f);
  CHECK(m.roughness.value == 0.75f);
  CHECK(m.specular.value == 0.5f);
  CHECK(m.specular_color.value == Rgb{1, 2, 3});
  CHECK(m.ior == 1.3f);
  CHECK(m.transmission.value == 0.9f);
  CHECK_FALSE(m.is_thin);
  const Scene thin =
      with_material("{'extensions':{'KHR_materials_transmission':{'transmissionFactor':1}}}");
  CHECK(only_material(thin).is_thin);
}

TEST_CASE("without metal, specular and transmission a material is diffuse") {
  const std::string no_metal = "'pbrMetallicRoughness':{'metallicFactor':0}";
  const std::string no_specular = "'KHR_materials_specular':{'specularFactor':0}";
  CHECK(
      only_material(with_material("{" + no_metal + ",'extensions':{" + no_specular + "}}")).kind ==
      MaterialKind::diffuse);
  CHECK(only_material(with_material("{" + no_metal + "}")).kind ==
        MaterialKind::metallic_roughness);
  CHECK(only_material(with_material("{'extensions':{" + no_specular + "}}")).kind ==
        MaterialKind::metallic_roughness);
  CHECK(only_material(with_material("{" + no_metal + ",'extensions':{" + no_specular +
                                    ",'KHR_materials_transmission':{'transmissionFactor':0.5}}}"))
            .kind == MaterialKind::metallic_roughness);
}

TEST_CASE("alpha modes") {
  const Scene mask = with_material("{'alphaMode':'MASK','alphaCutoff':0.25}");
  CHECK(only_material(mask).is_alpha_masked);
  CHECK(only_material(mask).alpha_cutoff == 0.25f);
  const Scene blend =
      with_material("{'alphaMode':'BLEND','pbrMetallicRoughness':{'baseColorFactor':[1,1,1,0.3]}}");
  CHECK(only_material(blend).is_alpha_masked);
  CHECK(only_material(blend).is_alpha_blended);
  CHECK_FALSE(only_material(mask).is_alpha_blended);
  CHECK(only_material(blend).alpha.value == 0.3f);
  CHECK(coverage(blend.textures, only_material(blend), Vec2{0, 0}) == 0.3f);
  CHECK(blend.warnings.total() == 0);
  const Scene opaque_blend = with_material("{'alphaMode':'BLEND'}");
  CHECK_FALSE(only_material(opaque_blend).is_alpha_masked);
  error_of(square_scene("[{'mesh':0}]", "'materials':[{'alphaMode':'GLASS'}]"));
}

TEST_CASE("negative and odd emission") {
  error_of(square_scene("[{'mesh':0}]", "'materials':[{'emissiveFactor':[1,-1,1]}]"));
  error_of(square_scene("[{'mesh':0}]",
                        "'materials':[{'emissiveFactor':[1,1,1],'extensions':{"
                        "'KHR_materials_emissive_strength':{'emissiveStrength':1e300}}}]"));
  CHECK(with_material("{'emissiveFactor':[0,0,0]}").lights.empty());
}

TEST_CASE("textures: sampler, transform, colour or data, and one decoding for all") {
  const TempFolder folder;
  // PFM is the supported image format that is easiest to write.
  folder.write("a.pfm", "PF\n2 1\n-1.0\n" + bytes_of<float>({1, 0, 0, 0, 0, 1}));
  const std::string path = folder.write(
      "scene.gltf",
      square_scene(
          "[{'mesh':0}]",
          "'images':[{'uri':'a.pfm'}],'samplers':[{'wrapS':33071,'wrapT':33648,"
          "'magFilter':9728}],'textures':[{'source':0,'sampler':0},{'source':0}],'materials':["
          "{'pbrMetallicRoughness':{'baseColorTexture':{'index':0,'extensions':{"
          "'KHR_texture_transform':{'offset':[0.5,0.25],'scale':[2,3],'rotation':1}}},"
          "'metallicRoughnessTexture':{'index':1}},'normalTexture':{'index':1,'scale':0.5}}]"));
  const Scene scene = import_gltf(path);
  const Material& m = only_material(scene);
  REQUIRE(scene.textures.size() == 2);  // one for the base colour, one for both kinds of data
  REQUIRE(m.base_color.texture >= 0);
  const Texture& t = scene.textures[size_t(m.base_color.texture)];
  CHECK(t.kind == TextureKind::image);
  CHECK(t.width == 2);
  CHECK(t.height == 1);
  CHECK(t.wrap_u == WrapMode::clamp);
  CHECK(t.wrap_v == WrapMode::mirror);
  CHECK_FALSE(t.is_filtered);
  CHECK(t.uv_offset == Vec2{0.5f, 0.25f});
  CHECK(t.uv_scale == Vec2{2, 3});
  CHECK(t.uv_rotation_rad == 1);
  CHECK(m.roughness.texture == m.metallic.texture);
  CHECK(m.roughness.channel == 1);
  CHECK(m.metallic.channel == 2);
  CHECK(m.normal_texture == m.roughness.texture);
  CHECK(m.normal_scale == 0.5f);
  const Texture& data = scene.textures[size_t(m.normal_texture)];
  CHECK_FALSE(data.is_srgb);
  CHECK(data.is_filtered);
  CHECK(data.wrap_u == WrapMode::repeat);
}

TEST_CASE("missing and broken images are warnings; grey stands for colours, the factor for data") {
  for (const std::string image : {"{'uri':'nothing.png'}", "{'uri':'data:image/png;base64,AAAA'}",
                                  "{'bufferView':1}", "{}"}) {
    CAPTURE(image);
    const Scene scene = with_material(
        "{'pbrMetallicRoughness':{'baseColorTexture':{'index':0}},"
        "'normalTexture':{'index':0}}",
        ",'images':[" + image + "],'textures':[{'source':0}]");
    CHECK(only_material(scene).base_color.texture == no_texture);
    CHECK(only_material(scene).normal_texture == no_texture);
    CHECK(only_material(scene).base_color.value == Rgb{0.5f});
    CHECK(has_warning(scene, "grey replaces it"));
  }
  const Scene none = with_material("{'normalTexture':{'index':0}}", ",'textures':[{}]");
  CHECK(has_warning(none, "no image of a supported format"));
}

TEST_CASE("images outside the scene's folder are not read: one beside the scene, or grey") {
  const TempFolder folder;
  folder.write("a.pfm", "PF\n1 1\n-1.0\n" + bytes_of<float>({1, 0, 0}));
  const auto color_of = [&](const std::string& uri) {
    const Scene scene = import_gltf(folder.write(
        "scene.gltf",
        square_scene("[{'mesh':0}]",
                     "'materials':[{'pbrMetallicRoughness':{'baseColorTexture':{'index':0}}}],"
                     "'textures':[{'source':0}],'images':[{'uri':'" +
                         uri + "'}]")));
    return evaluate(scene.textures, scene.materials.at(scene.meshes.at(0).material).base_color,
                    Vec2{0.5f, 0.5f});
  };
  CHECK(color_of("../textures/a.pfm") == Rgb{1, 0, 0});
  CHECK(color_of("../textures/b.pfm") == Rgb{0.5f});
  CHECK(color_of("http://example.org/b.pfm") == Rgb{0.5f});
  CHECK(color_of("%2e%2e/%2e%2e/etc/hostname") == Rgb{0.5f});
}

TEST_CASE("an emissive texture keeps the mesh a mesh source") {
  const TempFolder folder;
  folder.write("a.pfm", "PF\n2 1\n-1.0\n" + bytes_of<float>({1, 0, 0, 0, 0, 1}));
  const Scene scene = import_gltf(folder.write(
      "scene.gltf", square_scene("[{'mesh':0}]",
                                 "'images':[{'uri':'a.pfm'}],'textures':[{'source':0}],"
                                 "'materials':[{'emissiveFactor':[1,1,1],'emissiveTexture':"
                                 "{'index':0}}]")));
  REQUIRE(scene.lights.size() == 1);
  CHECK(scene.lights[0].kind == LightKind::mesh);
  CHECK(scene.lights[0].texture == 0);
  CHECK(scene.meshes[0].uvs.size() == 4);
}

TEST_CASE("KHR_materials_pbrSpecularGlossiness: a dielectric of that reflectance") {
  const auto extension = [](const std::string& members) {
    return "{'extensions':{'KHR_materials_pbrSpecularGlossiness':{" + members + "}}}";
  };
  const Scene plain =
      with_material(extension("'diffuseFactor':[0.5,0.25,0,1],'specularFactor':[0.2,0.4,0.1],"
                              "'glossinessFactor':0.75"));
  const Material& m = only_material(plain);
  CHECK(m.base_color.value == Rgb{0.5f, 0.25f, 0});
  CHECK(m.metallic.value == 0);
  CHECK(m.roughness.value == 0.25f);
  // (ior - 1)² / (ior + 1)² = 0.04, tinted to the factor
  CHECK(m.specular_color.value.g * 0.04f == doctest::Approx(0.4));
  CHECK(m.ior == 1.5f);
  error_of(square_scene("[{'mesh':0}]", "'materials':[" + extension("'specularFactor':[1]") + "]"));

  const TempFolder folder;
  folder.write("g.tga", std::string("\0\0\2\0\0\0\0\0\0\0\0\0\1\0\1\0\x20\x08", 18) +
                            std::string("\x10\x20\x30\x66", 4));
  const Scene textured = import_gltf(folder.write(
      "s.gltf", square_scene("[{'mesh':0}]",
                             "'images':[{'uri':'g.tga'}],'textures':[{'source':0}],'materials':[" +
                                 extension("'specularGlossinessTexture':{'index':0},"
                                           "'glossinessFactor':0.5") +
                                 "]")));
  const Material& t = textured.materials.at(0);
  CHECK(evaluate(textured.textures, t.roughness, Vec2{0, 0}) ==
        doctest::Approx(1 - 0.5 * 0x66 / 255.0).epsilon(0.005));
}

TEST_CASE(
    "unsupported properties of materials cause a warning, and are approximated where possible") {
  const Scene unlit = with_material("{'extensions':{'KHR_materials_unlit':{}}}");
  CHECK(only_material(unlit).kind == MaterialKind::diffuse);
  CHECK(has_warning(unlit, "unlit"));
  CHECK(has_warning(with_material("{'extensions':{'KHR_materials_dispersion':{}}}"), "dispersion"));
  for (const std::string name : {"sheen", "iridescence", "anisotropy", "clearcoat"})
    CHECK(with_material("{'extensions':{'KHR_materials_" + name + "':{}}}").warnings.total() == 0);
}

TEST_CASE("sheen and anisotropy: factors and textures") {
  const TempFolder folder;
  folder.write("a.pfm", "PF\n2 1\n-1.0\n" + bytes_of<float>({1, 0, 0, 0, 0, 1}));
  const std::string image = "'images':[{'uri':'a.pfm'}],'textures':[{'source':0}],";
  const auto with = [&](const std::string& more) {
    return import_gltf(folder.write(
        "scene.gltf", square_scene("[{'mesh':0}]", image + "'materials':[{" + more + "}]")));
  };
  const std::string cloth =
      "'KHR_materials_sheen':{'sheenColorFactor':[1,0.5,0],'sheenRoughnessFactor':0.25,"
      "'sheenColorTexture':{'index':0},'sheenRoughnessTexture':{'index':0}}";
  Scene scene = with("'pbrMetallicRoughness':{'metallicFactor':0},'extensions':{" + cloth + "}");
  CHECK(scene.warnings.total() == 0);
  Material m = only_material(scene);
  CHECK(m.sheen_color.value == Rgb{1, 0.5f, 0});
  CHECK(m.sheen_color.texture >= 0);
  CHECK(m.sheen_roughness.value == 0.25f);
  CHECK(m.sheen_roughness.channel == 3);
  CHECK(m.sheen_roughness.texture >= 0);
  CHECK(with("'extensions':{" + cloth + ",'KHR_materials_transmission':{'transmissionFactor':1}}")
            .warnings.total() == 0);
  // Sheen rules out the Lambert model even without specular reflection.
  scene = with("'pbrMetallicRoughness':{'metallicFactor':0},'extensions':{" + cloth +
               ",'KHR_materials_specular':{'specularFactor':0}}");
  CHECK(only_material(scene).kind == MaterialKind::metallic_roughness);
  scene = with(
      "'extensions':{'KHR_materials_anisotropy':{'anisotropyStrength':0.5,"
      "'anisotropyRotation':1.5,'anisotropyTexture':{'index':0}}}");
  CHECK(scene.warnings.total() == 0);
  m = only_material(scene);
  CHECK(m.anisotropy.value == 0.5f);
  CHECK(m.anisotropy.channel == 2);
  CHECK(m.anisotropy.texture >= 0);
  CHECK(m.anisotropy_rotation_rad == 1.5f);
  CHECK(m.roughness.value == 1);
  scene = with(
      "'pbrMetallicRoughness':{'metallicFactor':0,'roughnessFactor':0.5},'extensions':{"
      "'KHR_materials_transmission':{'transmissionFactor':1},"
      "'KHR_materials_anisotropy':{'anisotropyStrength':1}}");
  CHECK(has_warning(scene, "anisotropic transmission is approximated"));
  // geometric mean of the widths 1/4 and 1
  CHECK(sqr(only_material(scene).roughness.value) == doctest::Approx(0.5));
}

TEST_CASE("clear coats and thin films: factors and textures") {
  const TempFolder folder;
  folder.write("a.pfm", "PF\n2 1\n-1.0\n" + bytes_of<float>({1, 0.5f, 0, 0, 0, 1}));
  const std::string image = "'images':[{'uri':'a.pfm'}],'textures':[{'source':0}],";
  const auto with = [&](const std::string& extensions) {
    return import_gltf(folder.write(
        "scene.gltf",
        square_scene("[{'mesh':0}]", image + "'materials':[{'extensions':{" + extensions + "}}]")));
  };
  Scene scene = with(
      "'KHR_materials_clearcoat':{'clearcoatFactor':0.5,'clearcoatRoughnessFactor':0.25,"
      "'clearcoatTexture':{'index':0},'clearcoatRoughnessTexture':{'index':0},"
      "'clearcoatNormalTexture':{'index':0,'scale':0.5}}");
  CHECK(scene.warnings.total() == 0);
  Material m = only_material(scene);
  CHECK(m.roughness.value == 1);
  CHECK(m.metallic.value == 1);
  const Vec2 left{0.25f, 0.5f};
  CHECK(evaluate(scene.textures, m.coat, left) == 0.5f);
  CHECK(evaluate(scene.textures, m.coat_roughness, left) == doctest::Approx(0.125));
  CHECK(has_own_coat_normal(m));
  CHECK(m.coat_normal_texture >= 0);
  CHECK(m.coat_normal_scale == 0.5f);
  CHECK(m.coat_ior == 1.5f);
  scene = with(
      "'KHR_materials_clearcoat':{'clearcoatFactor':1},"
      "'KHR_materials_transmission':{'transmissionFactor':1}");
  CHECK(scene.warnings.total() == 0);
  CHECK(only_material(scene).coat.value == 1);
  CHECK(only_material(scene).transmission.value == 1);
  scene = with(
      "'KHR_materials_iridescence':{'iridescenceFactor':0.5,'iridescenceIor':1.4,"
      "'iridescenceTexture':{'index':0},'iridescenceThicknessMinimum':200,"
      "'iridescenceThicknessMaximum':600,'iridescenceThicknessTexture':{'index':0}}");
  CHECK(scene.warnings.total() == 0);
  m = only_material(scene);
  CHECK(evaluate(scene.textures, m.iridescence, left) == 0.5f);
  CHECK(evaluate(scene.textures, m.film_thickness, left) == 0.5f);
  CHECK(m.film_ior == 1.4f);
  CHECK(m.film_thinnest_nm == 200);
  CHECK(m.film_thickest_nm == 600);
  const std::string filmed_glass =
      "'KHR_materials_iridescence':{'iridescenceFactor':1},"
      "'KHR_materials_transmission':{'transmissionFactor':1}";
  CHECK_FALSE(has_warning(with(filmed_glass), "rough glass"));  // a sheet
  const std::string solid = filmed_glass + ",'KHR_materials_volume':{'thicknessFactor':1}";
  CHECK(with(solid).warnings.total() == 0);
  const std::string uneven = "'iridescenceTexture':{'index':0},";
  const std::string place = "'KHR_materials_iridescence':{";
  std::string varying = solid;
  varying.insert(varying.find(place) + place.size(), uneven);
  CHECK(has_warning(with(varying), "a varying film over rough glass"));
  CHECK(m.specular_color.value == Rgb{1});
}

TEST_CASE("a broken data URI causes a warning even if its image is unused") {
  const Scene scene = with_material("{}",
                                    ",'images':[{'uri':'data:image/png;base64,A'},"
                                    "{'uri':'data:image/png;base64,AAAA'}]");
  CHECK(has_warning(scene, "/images/0/uri: is a malformed data URI"));
  CHECK(scene.warnings.total() == 1);
}

TEST_CASE("a thin body is a sheet and keeps its film, also if it absorbs") {
  for (const float absorption : {0.0f, 1.0f}) {
    Scene scene;
    Material& glass = scene.materials.emplace_back();
    glass.kind = MaterialKind::metallic_roughness;
    glass.transmission.value = glass.iridescence.value = 1;
    glass.metallic.value = 0;
    glass.absorption = Rgb{absorption};
    Mesh& box = scene.meshes.emplace_back();
    for (const float z : {0.0f, 0.01f})
      for (const Vec2 p : {Vec2{0, 0}, Vec2{1, 0}, Vec2{1, 1}, Vec2{0, 1}})
        box.positions.push_back({p.x, p.y, z});
    box.triangles = {{0, 2, 1}, {0, 3, 2}, {4, 5, 6}, {4, 6, 7}};
    for (uint32_t i = 0; i < 4; ++i) {
      const uint32_t j = (i + 1) % 4;
      box.triangles.push_back({i, j, j + 4});
      box.triangles.push_back({i, j + 4, i + 4});
    }
    replace_thin_glass(scene);
    CHECK(scene.meshes.at(0).triangles.size() == 2);  // a sheet
    CHECK(scene.warnings.total() == 0);
    CHECK(scene.materials.at(scene.meshes[0].material).iridescence.value == 1);
  }
}

}  // namespace test_gltf_material
