// Tests of repeated meshes, as instances and as copies.
#include "import/import.h"

#include <doctest/doctest.h>

#include <cmath>
#include <cstring>
#include <string>

#include "base/error.h"
#include "import/gltf/mesh_instancer.h"
#include "import/gltf_builder.h"
#include "import/temp_folder.h"
#include "scene/mesh_in_world.h"
#include "support/instanced_scenes.h"

using namespace troffer;

namespace test_instances {
using troffer::test::dented_ball;

namespace {

// Returns a ball with so many triangles that a scene shares it from the first placement on.
const Mesh& large_ball() {
  static const Mesh ball = dented_ball(0, 520);
  return ball;
}

std::string ply_of(const Mesh& m, bool has_normals) {
  std::string text = "ply\nformat binary_little_endian 1.0\nelement vertex " +
                     std::to_string(m.positions.size()) +
                     "\nproperty float x\nproperty float y\nproperty float z\n";
  if (has_normals) text += "property float nx\nproperty float ny\nproperty float nz\n";
  text += "element face " + std::to_string(m.triangles.size()) +
          "\nproperty list uchar int vertex_indices\nend_header\n";
  const auto add = [&](const auto& value) {
    char bytes[sizeof value];
    std::memcpy(bytes, &value, sizeof value);
    text.append(bytes, sizeof value);
  };
  for (size_t v = 0; v < m.positions.size(); ++v) {
    add(m.positions[v]);
    if (has_normals) add(m.normals[v]);
  }
  for (const Triangle& t : m.triangles) {
    add(uint8_t{3});
    add(t);
  }
  return text;
}

// Compares each instance with its copy in the second scene, in order.
void check_same(const Scene& scene, const Scene& copies, size_t first_copy) {
  REQUIRE(copies.instances.empty());
  REQUIRE(copies.meshes.size() >= first_copy + scene.instances.size());
  for (uint32_t k = 0; k < scene.instances.size(); ++k) {
    const MeshInWorld mesh = mesh_at(scene, first_instance(scene) + k);
    const Mesh& copy = copies.meshes[first_copy + k];
    REQUIRE(mesh.size() == copy.triangles.size());
    size_t differ = 0;
    for (size_t t = 0; t < mesh.size(); ++t) {
      const Triangle& c = copy.triangles[t];
      const std::array<Vec3, 3> p = mesh.corners(t);
      for (size_t v = 0; v < 3; ++v) {
        differ += !(p[v] == copy.positions[c[v]]);
        if (!copy.normals.empty())
          differ += length(mesh.normal(mesh.triangle(t)[v]) - copy.normals[c[v]]) > 1e-5f;
      }
    }
    CAPTURE(k);
    CHECK(differ == 0);
    CHECK(mesh.mesh().normals.empty() == copy.normals.empty());
  }
}

constexpr const char* places[] = {"Translate 1 2 3\n", "Rotate 40 1 2 0\nScale 2 -1 .5\n",
                                  "Translate -3 0 0\nScale 1 1 -1\n"};

Mesh small_ball() {
  return dented_ball(0, 16);
}

}  // namespace

TEST_CASE("pbrt objects become instances with the place and orientation of copies") {
  const TempFolder folder;
  folder.write("ball.ply", ply_of(large_ball(), true));
  folder.write("bare.ply", ply_of(large_ball(), false));
  for (const auto& [turned, far] : {std::pair<std::string, std::string>{"", ""},
                                    {"ReverseOrientation\n", "Translate 500000 0 0\n"}}) {
    const auto shape = [&](const std::string& file) {
      return turned + "Scale .5 -1 1\nShape \"plymesh\" \"string filename\" \"" + file + "\"\n";
    };
    std::string objects = "WorldBegin\n", copies = "WorldBegin\n";
    for (const std::string file : {"ball.ply", "bare.ply"}) {
      objects += "ObjectBegin \"" + file + "\"\n" + shape(file) + "ObjectEnd\n";
      for (const std::string place : places) {
        objects +=
            "AttributeBegin\n" + far + place + "ObjectInstance \"" + file + "\"\nAttributeEnd\n";
        copies += "AttributeBegin\n" + far + place + shape(file) + "AttributeEnd\n";
      }
    }
    const Scene scene = import_scene(folder.write("objects.pbrt", objects));
    CHECK(scene.meshes.empty());
    CHECK(scene.instanced_meshes.size() == 2);
    CHECK(scene.instances.size() == 6);
    const Scene by_copies = import_scene(folder.write("copies.pbrt", copies));
    CHECK((scene.origin != Vec3d{}) == !far.empty());
    CHECK(scene.origin == by_copies.origin);
    check_same(scene, by_copies, 0);
  }
}

TEST_CASE("objects that cannot be instances are copied; objects used once become meshes") {
  const TempFolder folder;
  folder.write("ball.ply", ply_of(large_ball(), true));
  const std::string object =
      "WorldBegin\nObjectBegin \"o\"\nShape \"plymesh\" \"string filename\" \"ball.ply\"\n"
      "ObjectEnd\n";
  const std::string one = "ObjectInstance \"o\"\n";
  const auto with = [&](const std::string& text) {
    return import_scene(folder.write("s.pbrt", object + text));
  };
  const Scene once = with(one);
  CHECK(once.instances.empty());
  CHECK(once.instanced_meshes.empty());
  REQUIRE(once.meshes.size() == 1);
  CHECK(once.meshes[0].triangles.size() == large_ball().triangles.size());

  const Scene flat = with(one + one + "Scale 1 1 0\n" + one);
  CHECK(flat.instances.size() == 2);
  REQUIRE(flat.meshes.size() == 1);
  for (const Vec3& p : flat.meshes[0].positions) CHECK(p.z == 0);

  // At this small scale, some triangles lose their area to rounding and are left out.
  const Scene tiny = with(one + one + "Translate 100 100 100\nScale 1e-4 1e-4 1e-4\n" + one);
  CHECK(tiny.instances.size() == 2);
  CHECK(tiny.meshes.size() <= 1);
  CHECK(tiny.warnings.total() > 0);

  const Scene gone = with("Scale 0 0 0\n" + one);
  CHECK(gone.instances.empty());
  CHECK(gone.instanced_meshes.empty());
}

TEST_CASE("few copies, and objects with few triangles, are copied instead of instanced") {
  Scene scene;
  scene.materials.resize(2);
  scene.materials[1].kind = MaterialKind::dielectric;
  scene.materials[1].roughness.value = 0;
  PlacedBounds bounds;
  MeshInstancer instancer(scene, bounds);
  const Mesh ball = small_ball();
  const size_t n = ball.triangles.size();
  int made = 0, copied = 0;
  const auto place = [&](uint32_t material, size_t triangles, const Affine& at) {
    return instancer.place({&ball, material, 0}, triangles, at, "name", [&] {
      ++made;
      return ball;
    });
  };
  CHECK_FALSE(place(0, 60, Affine()));  // claims few triangles
  CHECK_FALSE(place(1, n, Affine()));   // might be a pane
  while (!place(0, n, Affine::translate({5, 0, 0}))) ++copied;
  CHECK(made == 1);
  CHECK(copied * n > 2'000'000);
  CHECK(copied * n < 2'200'000);
  for (int i = 1; i < 10; ++i) CHECK(place(0, n, Affine::translate({5, double(i), 0})));
  CHECK_FALSE(place(0, n, Affine::scale({1, 1, 0})));
  CHECK(made == 1);
  CHECK(scene.instances.size() == 10);
  CHECK(scene.instances[0].name == "name");
  CHECK(bounds.box().lower.x > 3);
  CHECK(bounds.box().upper.y > 9);
  finalize_instances(scene);
  CHECK(scene.instances.size() == 10);
}

TEST_CASE("shared meshes and instances of glTF are stored once; emitters are copied") {
  const TempFolder folder;
  const Mesh& ball = large_ball();
  folder.write("b.bin", bytes_of(ball.positions) + bytes_of(ball.triangles) +
                            bytes_of(ball.normals) +
                            bytes_of<float>({0, 0, 5, 0, 5, 5, 1, 1, 1, 2, 2, -2}));
  const size_t v = 12 * ball.positions.size(), t = 12 * ball.triangles.size();
  const auto text = [&](const std::string& material, const std::string& nodes, int many) {
    const auto view = [&](size_t from, size_t size) {
      return "{'buffer':0,'byteOffset':" + std::to_string(from) +
             ",'byteLength':" + std::to_string(size) + "}";
    };
    const auto vectors = [](int at, size_t count) {
      return "{'bufferView':" + std::to_string(at) +
             ",'componentType':5126,'type':'VEC3','count':" + std::to_string(count) + "}";
    };
    // Many instances: an accessor without data is all zeros.
    return gltf_text(
        "'buffers':[{'byteLength':" + std::to_string(2 * v + t + 48) +
        ",'uri':'b.bin'}],'bufferViews':[" + view(0, v) + "," + view(v, t) + "," + view(v + t, v) +
        "," + view(2 * v + t, 24) + "," + view(2 * v + t + 24, 24) + "],'accessors':[" +
        vectors(0, ball.positions.size()) +
        ",{'bufferView':1,'componentType':5125,'type':'SCALAR','count':" +
        std::to_string(3 * ball.triangles.size()) + "}," + vectors(2, ball.positions.size()) + "," +
        vectors(3, 2) + "," + vectors(4, 2) + ",{'componentType':5126,'type':'VEC3','count':" +
        std::to_string(many) + "}]," + "'materials':[" + material +
        "],'meshes':[{'primitives':[{'attributes':{'POSITION':0,'NORMAL':2},'indices':1,"
        "'material':0}]}],'extensionsUsed':['EXT_mesh_gpu_instancing'],'nodes':[" +
        nodes + "]");
  };
  const auto read = [&](const std::string& material, const std::string& nodes, int many = 1) {
    return import_scene(folder.write("s.gltf", text(material, nodes, many)));
  };
  const std::string by_nodes =
      "{'mesh':0,'translation':[0,0,5]},{'mesh':0,'translation':[0,5,5],'scale':[2,2,-2]}";
  const std::string by_attributes =
      "{'mesh':0,'name':'n','extensions':{'EXT_mesh_gpu_instancing':{'attributes':{"
      "'TRANSLATION':3,'SCALE':4}}}}";
  const Scene nodes = read("{}", by_nodes), attributes = read("{}", by_attributes);
  const Scene lamps = read("{'emissiveFactor':[1,1,1]}", by_nodes);
  CHECK(nodes.meshes.empty());
  CHECK(nodes.instances.size() == 2);
  CHECK(attributes.instances.size() == 2);
  CHECK(attributes.instances[1].name == "n");
  CHECK(attributes.instances[1].is_mirrored);
  CHECK(lamps.instances.empty());
  CHECK(lamps.meshes.size() == 2);
  check_same(nodes, lamps, 0);
  check_same(attributes, lamps, 0);
  CHECK(read("{}", "{'mesh':0}").instances.empty());
  // 270 000 triangles times 20 000 exceed 32 bits and must be refused before placement.
  std::string crowd = by_attributes;
  crowd.replace(crowd.find("'TRANSLATION':3,'SCALE':4"), 25, "'TRANSLATION':5");
  CHECK_THROWS_WITH_AS(read("{}", crowd, 20'000), doctest::Contains("4000000000 by instances"),
                       InputError);
  CHECK_THROWS_WITH_AS(read("{'emissiveFactor':[1,1,1]}", crowd, 1000),
                       doctest::Contains("more than 60000000 triangles"), InputError);
}

TEST_CASE("shape groups of Mitsuba, also nested ones, are stored once") {
  const TempFolder folder;
  folder.write("ball.ply", ply_of(large_ball(), true));
  folder.write("bare.ply", ply_of(large_ball(), false));
  const auto shape = [](const std::string& file, const std::string& inside) {
    return "<shape type=\"ply\"><string name=\"filename\" value=\"" + file +
           "\"/><boolean name=\"face_normals\" value=\"" + (file == "bare.ply" ? "true" : "false") +
           "\"/>" + inside + "</shape>\n";
  };
  const std::string outer = "<scale x=\"1\" y=\"1\" z=\"-1\"/><translate y=\"3\"/>";
  const std::string inner = "<rotate x=\"1\" angle=\"30\"/><translate x=\"4\"/>";
  const auto transform = [](const std::string& what) {
    return "<transform name=\"to_world\">" + what + "</transform>";
  };
  for (const std::string file : {"ball.ply", "bare.ply"}) {
    const std::string group = "<shape type=\"shapegroup\" id=\"a\">" + shape(file, "") +
                              "</shape>\n<shape type=\"shapegroup\" id=\"b\">"
                              "<shape type=\"instance\"><ref id=\"a\"/>" +
                              transform(inner) + "</shape></shape>\n";
    const Scene scene = import_scene(folder.write(
        "s.xml", "<scene version=\"3.0.0\">" + group +
                     "<shape type=\"instance\"><ref id=\"b\"/></shape>"
                     "<shape type=\"instance\"><ref id=\"b\"/>" +
                     transform(outer) + "</shape><shape type=\"instance\"><ref id=\"a\"/>" +
                     transform("<translate z=\"9\"/>") + "</shape>" +
                     "<shape type=\"instance\"><ref id=\"a\"/>" + transform(outer) +
                     "</shape></scene>"));
    const Scene copies = import_scene(
        folder.write("c.xml", "<scene version=\"3.0.0\">" + shape(file, transform(inner)) +
                                  shape(file, transform(inner + outer)) +
                                  shape(file, transform("<translate z=\"9\"/>")) +
                                  shape(file, transform(outer)) + "</scene>"));
    CHECK(scene.meshes.empty());
    CHECK(scene.instances.size() == 4);
    // Without normals, a mirrored mesh is stored with its own winding.
    CHECK(scene.instanced_meshes.size() == (file == "bare.ply" ? 2 : 1));
    check_same(scene, copies, 0);
  }
}

}  // namespace test_instances
