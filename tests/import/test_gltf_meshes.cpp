// Tests of glTF meshes that are skinned, morphed, instanced, hidden or coloured.
#include <doctest/doctest.h>

#include <cmath>

#include "import/gltf_builder.h"

using namespace troffer;

namespace test_gltf_meshes {

namespace {

// An accessor that square_with() adds after the square's four. Their data follows in `bytes`,
// tightly packed.
struct More {
  const char* type;
  int component_type, count, bytes;
  bool is_normalized = false;
};
std::string square_with(const std::string& bytes, const std::vector<More>& more) {
  const std::string square = square_bytes();
  std::string views =
      "{'buffer':0,'byteLength':48},{'buffer':0,'byteOffset':48,'byteLength':12},"
      "{'buffer':0,'byteOffset':60,'byteLength':48},{'buffer':0,'byteOffset':108,'byteLength':32}";
  std::string accessors =
      "{'bufferView':0,'componentType':5126,'count':4,'type':'VEC3'},"
      "{'bufferView':1,'componentType':5123,'count':6,'type':'SCALAR'},"
      "{'bufferView':2,'componentType':5126,'count':4,'type':'VEC3'},"
      "{'bufferView':3,'componentType':5126,'count':4,'type':'VEC2'}";
  size_t at = square.size();
  for (size_t i = 0; i < more.size(); ++i) {
    views += ",{'buffer':0,'byteOffset':" + std::to_string(at) +
             ",'byteLength':" + std::to_string(more[i].bytes) + "}";
    accessors += ",{'bufferView':" + std::to_string(4 + i) +
                 ",'componentType':" + std::to_string(more[i].component_type) +
                 (more[i].is_normalized ? ",'normalized':true" : "") +
                 ",'count':" + std::to_string(more[i].count) + ",'type':'" + more[i].type + "'}";
    at += size_t(more[i].bytes);
  }
  return "'buffers':[" + data_buffer(square + bytes) + "],'bufferViews':[" + views +
         "],'accessors':[" + accessors + "]";
}

void check_near(const Vec3& a, const Vec3& b) {
  for (size_t i = 0; i < 3; ++i) CHECK(a[i] == doctest::Approx(b[i]).epsilon(1e-5));
}

Rgb color_at(const Scene& scene, const Mesh& mesh, size_t triangle, const Vec3& weights) {
  Vec2 uv{0, 0};
  for (size_t k = 0; k < 3; ++k)
    if (!mesh.uvs.empty()) uv = uv + mesh.uvs[mesh.triangles[triangle][k]] * weights[k];
  return evaluate(scene.textures, scene.materials[mesh.material].base_color, uv);
}

}  // namespace

TEST_CASE("a skin bends a mesh by its joints, wherever its own node stands") {
  // Vertices 0 and 1 follow joint 0, vertices 2 and 3 joint 1. Joint 1 is one unit up and turned by
  // a quarter around x; its bind matrix moves y = 1 to the origin.
  std::vector<uint8_t> joints;
  std::vector<float> weights;
  for (const uint8_t j : {0, 0, 1, 1}) {
    joints.insert(joints.end(), {j, 0, 0, 0});
    weights.insert(weights.end(), {0.5f, 0, 0, 0});  // must be normalised
  }
  const std::vector<float> binds{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0,  0, 1,
                                 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, -1, 0, 1};
  const Scene scene = import_text(gltf_text(
      square_with(bytes_of(joints) + bytes_of(weights) + bytes_of(binds),
                  {{"VEC4", 5121, 4, 16}, {"VEC4", 5126, 4, 64}, {"MAT4", 5126, 2, 128}}) +
      ",'meshes':[{'primitives':[{'attributes':{'POSITION':0,'NORMAL':2,'JOINTS_0':4,"
      "'WEIGHTS_0':5},'indices':1}]}],'skins':[{'joints':[1,2],'inverseBindMatrices':6}],"
      "'nodes':[{'mesh':0,'skin':0,'translation':[50,0,0]},{},"
      "{'translation':[0,3,0],'rotation':[0.70710678,0,0,0.70710678]}]"));
  REQUIRE(scene.meshes.size() == 1);
  const Mesh& m = scene.meshes[0];
  check_near(m.positions[0], {0, 0, 0});
  check_near(m.positions[1], {1, 0, 0});
  check_near(m.positions[2], {1, 3, 0});
  check_near(m.positions[3], {0, 3, 0});
  check_near(m.normals[0], {0, 0, 1});
  check_near(m.normals[2], {0, -1, 0});
  CHECK(scene.warnings.total() == 0);
}

TEST_CASE("morph targets: the node's weights, or else the mesh's") {
  const std::string data =
      square_with(bytes_of<float>({0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}), {{"VEC3", 5126, 4, 48}});
  const auto height = [&](const std::string& of_mesh, const std::string& of_node) {
    const Scene scene = import_text(
        gltf_text(data +
                  ",'meshes':[{'primitives':[{'attributes':{'POSITION':0},'indices':1,'targets':[{"
                  "'POSITION':4},{}]}]" +
                  of_mesh + "}],'nodes':[{'mesh':0" + of_node + "}]"));
    return scene.meshes.at(0).positions.at(2).z;
  };
  CHECK(height("", "") == 0);
  CHECK(height(",'weights':[0.5,1]", "") == 0.5f);
  CHECK(height(",'weights':[0.5,1]", ",'weights':[2,0]") == 2);
  CHECK(error_of(gltf_text(data + ",'meshes':[{'primitives':[{'attributes':{'POSITION':0},"
                                  "'indices':1,'targets':[{'POSITION':3}]}]}]"))
            .reason()
            .find("VEC3") != std::string::npos);
}

TEST_CASE("EXT_mesh_gpu_instancing: translation, rotation, scale of every instance") {
  const std::string data =
      square_with(bytes_of<float>({0, 0, 0, 0, 0, 7}) +
                      bytes_of<int16_t>({0, 0, 0, 32767, 0, 0, 23170, 23170}) +
                      bytes_of<float>({1, 1, 1, 2, 2, 2}),
                  {{"VEC3", 5126, 2, 24}, {"VEC4", 5122, 2, 16, true}, {"VEC3", 5126, 2, 24}});
  const auto text = [&](const std::string& scale) {
    return gltf_text(data +
                     ",'meshes':[{'primitives':[{'attributes':{'POSITION':0},'indices':1}]}],"
                     "'nodes':[{'mesh':0,'translation':[0,0,1],'extensions':{"
                     "'EXT_mesh_gpu_instancing':{'attributes':{'TRANSLATION':4,'ROTATION':5,"
                     "'SCALE':" +
                     scale + "}}}}]");
  };
  const Scene scene = import_text(text("6"));
  REQUIRE(scene.meshes.size() == 2);
  check_near(scene.meshes[0].positions[2], {1, 1, 1});
  for (size_t i = 0; i < 3; ++i)  // a quarter turn around z, twice as large
    CHECK(scene.meshes[1].positions[2][i] == doctest::Approx(Vec3(-2, 2, 8)[i]).epsilon(1e-3));
  CHECK(error_of(text("0")).reason().find("count differs") != std::string::npos);
}

TEST_CASE("KHR_node_visibility hides a node and what is below it") {
  const std::string hidden = "'extensions':{'KHR_node_visibility':{'visible':false}}";
  CHECK(import_text(square_scene("[{'mesh':0," + hidden + ",'children':[1]},{'mesh':0},{'mesh':0}]",
                                 "'materials':[{}]"))
            .meshes.size() == 1);
}

TEST_CASE("COLOR_0: one colour is a factor; several are interpolated exactly") {
  const auto scene_of = [](const std::vector<float>& colors, const std::string& material) {
    return import_text(
        gltf_text(square_with(bytes_of(colors), {{"VEC3", 5126, 4, 48}}) +
                  ",'meshes':[{'primitives':[{'attributes':{'POSITION':0,'NORMAL':2,'TEXCOORD_0':3,"
                  "'COLOR_0':4},'indices':1,'material':0}]}],'materials':[" +
                  material + "],'nodes':[{'mesh':0},{'mesh':0,'translation':[0,0,3]}]"));
  };
  const std::string red = "{'pbrMetallicRoughness':{'baseColorFactor':[0.5,1,1,1]}}";
  const Scene white = scene_of({1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1}, red);
  CHECK(white.materials.size() == 1);
  const Scene one = scene_of({1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0}, red);
  REQUIRE(one.meshes.size() == 2);
  CHECK(one.meshes[0].material == one.meshes[1].material);
  CHECK(one.materials[one.meshes[0].material].base_color.value == Rgb{0.5f, 0, 0});
  CHECK(one.textures.empty());

  const std::vector<float> colors{1, 0, 0, 0, 1, 0.5f, 0, 0, 1, 0.25f, 0.75f, 1};
  const Scene several = scene_of(colors, red);
  CHECK(several.warnings.total() == 0);
  const Mesh& mesh = several.meshes.at(0);
  CHECK(mesh.positions.size() == 6);
  CHECK(mesh.normals.size() == 6);
  const std::array<std::array<size_t, 3>, 2> corners{{{0, 1, 2}, {0, 2, 3}}};
  for (size_t t = 0; t < 2; ++t)
    for (const Vec3& w : {Vec3{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0.2f, 0.3f, 0.5f}, {0, .5f, .5f}}) {
      const Rgb c = color_at(several, mesh, t, w);
      for (size_t k = 0; k < 3; ++k) {
        float expected = 0;
        for (size_t i = 0; i < 3; ++i) expected += w[i] * colors[3 * corners[t][i] + k];
        CHECK(c[k] == doctest::Approx(expected * (k == 0 ? 0.5f : 1)).epsilon(1e-4));
      }
    }
}

TEST_CASE("COLOR_0 of a textured mesh is a factor on what its texture shows") {
  const TempFolder folder;
  folder.write("a.pfm", "PF\n1 1\n-1.0\n" + bytes_of<float>({1, 0.5f, 1}));
  const auto scene_of = [&](const std::string& second) {
    return import_gltf(folder.write(
        "s.gltf",
        gltf_text(square_with(bytes_of<uint8_t>({255, 0, 0, 255, 255, 0, 0, 255, 255, 0, 0, 255,
                                                 255, 255, 0, 255}),
                              {{"VEC4", 5121, 4, 16, true}}) +
                  ",'meshes':[{'primitives':[{'attributes':{'POSITION':0,'TEXCOORD_0':3," + second +
                  "'COLOR_0':4},'indices':1,'material':0}]}],'images':[{'uri':'a.pfm'}],"
                  "'textures':[{'source':0}],'materials':[{'pbrMetallicRoughness':{"
                  "'baseColorTexture':{'index':0}" +
                  (second.empty() ? "" : ",'metallicRoughnessTexture':{'index':0,'texCoord':1}") +
                  "}}],'nodes':[{'mesh':0}]")));
  };
  const Scene scene = scene_of("");
  CHECK(scene.warnings.total() == 0);
  const Mesh& mesh = scene.meshes.at(0);
  REQUIRE(mesh.uvs.size() == 6);
  REQUIRE(mesh.uvs_2.size() == 6);
  const Material& m = scene.materials[mesh.material];
  const std::array<std::array<size_t, 3>, 2> corners{{{0, 1, 2}, {0, 2, 3}}};
  for (size_t t = 0; t < 2; ++t)
    for (size_t k = 0; k < 3; ++k) {
      const uint32_t v = mesh.triangles[t][k];
      const Rgb c = evaluate(scene.textures, m.base_color, {mesh.uvs[v], mesh.uvs_2[v]});
      CHECK(c.r == doctest::Approx(1));
      CHECK(c.g == doctest::Approx(corners[t][k] == 3 ? 0.5 : 0));
      CHECK(c.b == doctest::Approx(0));
    }
  // Both sets are in use, so the mean over six corners applies.
  const Scene two = scene_of("'TEXCOORD_1':3,");
  const Mesh& plain = two.meshes.at(0);
  for (size_t t = 0; t < 2; ++t)
    for (size_t k = 0; k < 3; ++k)
      CHECK(mesh.uvs[mesh.triangles[t][k]] == plain.uvs[plain.triangles[t][k]]);
  CHECK(two.materials[two.meshes.at(0).material].base_color.value.g == doctest::Approx(1.0 / 6));
  CHECK(has_warning(two, "as their mean"));
}

}  // namespace test_gltf_meshes
