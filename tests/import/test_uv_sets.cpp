// Tests of two sets of texture coordinates.
#include <doctest/doctest.h>

#include "import/gltf_builder.h"

using namespace troffer;

namespace test_uv_sets {

namespace {

// Returns the unit square with two sets of coordinates: TEXCOORD_`a` as in square_bytes(), (x, 1 -
// y), and TEXCOORD_`b`, (y, x) / 2.
std::string square_with_sets(int a, int b, const std::string& more) {
  const std::string all = square_bytes() + bytes_of<float>({0, 0, 0, 0.5f, 0.5f, 0.5f, 0.5f, 0});
  std::string data = square_data();
  data.replace(data.find("{'byteLength'"), data.find("],") - data.find("{'byteLength'"),
               data_buffer(all));
  data.replace(data.find("'byteLength':32}"), 16,
               "'byteLength':32},{'buffer':0,'byteOffset':140,'byteLength':32}");
  data.pop_back();
  return gltf_text(data +
                   ",{'bufferView':4,'componentType':5126,'count':4,'type':'VEC2'}],"
                   "'meshes':[{'primitives':[{'attributes':{'POSITION':0,'NORMAL':2,'TEXCOORD_" +
                   std::to_string(a) + "':3,'TEXCOORD_" + std::to_string(b) +
                   "':4},'indices':1,'material':0}]}],'nodes':[{'mesh':0}]," + more);
}

// Returns a ramp along u: red and green, 8 texels wide, with u at their centres.
std::string ramp() {
  std::vector<float> texels;
  for (int i = 0; i < 8; ++i)
    for (int c = 0; c < 3; ++c) texels.push_back((float(i) + 0.5f) / 8);
  return "PF\n8 1\n-1.0\n" + bytes_of(texels);
}

struct Built {
  TempFolder folder;
  Scene load(const std::string& material, int a = 0, int b = 1) {
    folder.write("ramp.pfm", ramp());
    return import_gltf(folder.write(
        "scene.gltf", square_with_sets(a, b,
                                       "'samplers':[{'wrapS':33071,'wrapT':33071}],"
                                       "'images':[{'uri':'ramp.pfm'}],'textures':[{'source':0,"
                                       "'sampler':0}],'materials':[" +
                                           material + "]")));
  }
};

// Returns the texture coordinates at (x, y); they are linear over the square.
TexturePlace at(const Mesh& mesh, float x, float y) {
  const auto linear = [&](const std::vector<Vec2>& uvs) {
    return uvs[0] + (uvs[1] - uvs[0]) * x + (uvs[3] - uvs[0]) * y;
  };
  return TexturePlace(linear(mesh.uvs), linear(mesh.uvs_2));
}

}  // namespace

TEST_CASE("every texture is looked up by its own set of coordinates") {
  Built built;
  for (const bool is_swapped : {false, true}) {
    const Scene scene = built.load(
        "{'pbrMetallicRoughness':{'baseColorTexture':{'index':0,'texCoord':1},"
        "'metallicRoughnessTexture':{'index':0}},'normalTexture':{'index':0,'texCoord':7,"
        "'extensions':{'KHR_texture_transform':{'texCoord':0}}}}",
        is_swapped ? 1 : 0, is_swapped ? 0 : 1);
    CHECK(scene.warnings.total() == 0);
    CHECK(scene.meshes[0].uvs.size() == 4);
    CHECK(scene.meshes[0].uvs_2.size() == 4);
    const Material& m = scene.materials[0];
    const TexturePlace place = at(scene.meshes[0], 0.3f, 0.8f);
    const float by_first = 0.3f, by_second = 0.4f;  // x, y / 2
    CHECK(evaluate(scene.textures, m.base_color, place).r ==
          doctest::Approx(is_swapped ? by_first : by_second));
    CHECK(evaluate(scene.textures, m.roughness, place) ==
          doctest::Approx(is_swapped ? by_second : by_first));
    CHECK(m.normal_texture >= 0);
  }
}

TEST_CASE("meshes with one set store no second one; lights and masks use the first") {
  Built built;
  Scene scene = built.load("{'pbrMetallicRoughness':{'baseColorTexture':{'index':0}}}");
  CHECK(scene.meshes[0].uvs_2.empty());
  scene = built.load(
      "{'pbrMetallicRoughness':{'baseColorTexture':{'index':0}},'emissiveFactor':[1,1,1],"
      "'emissiveTexture':{'index':0,'texCoord':1}}");
  CHECK(scene.meshes[0].uvs[2] == Vec2{0.5f, 0.5f});
  CHECK(scene.meshes[0].uvs_2[2] == Vec2{1, 0});
  CHECK(scene.textures[size_t(scene.lights[0].texture)].mapping == TextureMapping::uv);
  scene = built.load(
      "{'alphaMode':'MASK','pbrMetallicRoughness':{'baseColorTexture':{'index':0}},"
      "'emissiveFactor':[1,1,1],'emissiveTexture':{'index':0,'texCoord':1}}");
  CHECK(has_warning(scene, "alpha and emission"));
  CHECK(scene.meshes[0].uvs[2] == Vec2{1, 0});
}

TEST_CASE("a third set and missing sets cause warnings") {
  Built built;
  const Scene scene = built.load(
      "{'pbrMetallicRoughness':{'baseColorTexture':{'index':0,'texCoord':1},"
      "'metallicRoughnessTexture':{'index':0,'texCoord':2}},'normalTexture':{'index':0}}");
  CHECK(has_warning(scene, "more than two sets"));
  CHECK(has_warning(scene, "TEXCOORD_2"));
  CHECK(scene.meshes[0].uvs.size() == 4);
  CHECK(scene.meshes[0].uvs_2.empty());
}

}  // namespace test_uv_sets
