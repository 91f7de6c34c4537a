// Tests of buffers, accessors, primitives and GLB: every way in which glTF stores triangles.
#include <doctest/doctest.h>

#include "import/gltf_builder.h"

using namespace troffer;

namespace test_gltf_data {

namespace {

std::string u32(uint32_t v) {
  return bytes_of<uint32_t>({v});
}

std::string chunk(const std::string& type, std::string bytes) {
  while (bytes.size() % 4 != 0) bytes += type == "JSON" ? ' ' : '\0';
  return u32(uint32_t(bytes.size())) + type + bytes;
}
std::string glb(const std::string& chunks) {
  return "glTF" + u32(2) + u32(uint32_t(12 + chunks.size())) + chunks;
}

Scene import_bytes(const std::string& name, const std::string& bytes) {
  const TempFolder folder;
  return import_gltf(folder.write(name, bytes));
}

// Returns a document with one mesh of one primitive over the accessors of `data`.
std::string one_primitive(const std::string& data, const std::string& primitive) {
  return gltf_text(data + ",\n'meshes':[{'primitives':[" + primitive + "]}],'nodes':[{'mesh':0}]");
}

// Returns 5 points of a zigzag strip in the plane z = 0, with y = 0 1 0 1 0.
std::string zigzag() {
  const std::string bytes = bytes_of<float>({0, 0, 0, 1, 1, 0, 2, 0, 0, 3, 1, 0, 4, 0, 0});
  return "'buffers':[" + data_buffer(bytes) +
         "],'bufferViews':[{'buffer':0,'byteLength':60}],'accessors':[{'bufferView':0,"
         "'componentType':5126,'count':5,'type':'VEC3'}]";
}

float front_z(const Mesh& mesh, size_t i) {
  const Triangle& t = mesh.triangles[i];
  const Vec3 a = mesh.positions[t[0]];
  return cross(mesh.positions[t[1]] - a, mesh.positions[t[2]] - a).z;
}

}  // namespace

TEST_CASE("triangles, strips and fans; points and lines are left out") {
  Scene scene = import_text(one_primitive(zigzag(), "{'attributes':{'POSITION':0},'mode':5}"));
  REQUIRE(scene.meshes.size() == 1);
  CHECK(scene.meshes[0].triangles.size() == 3);
  for (size_t i = 0; i < 3; ++i) CHECK(front_z(scene.meshes[0], i) < 0);  // all on the same side

  scene = import_text(one_primitive(zigzag(), "{'attributes':{'POSITION':0},'mode':6}"));
  CHECK(scene.meshes[0].triangles.size() == 3);
  scene = import_text(one_primitive(zigzag(), "{'attributes':{'POSITION':0}}"));
  CHECK(scene.meshes[0].triangles.size() == 1);
  CHECK(has_warning(scene, "multiple of 3"));
  for (const char* const mode : {"0", "1", "2", "3"}) {
    scene = import_text(
        one_primitive(zigzag(), std::string("{'attributes':{'POSITION':0},'mode':") + mode + "}"));
    CHECK(scene.meshes.empty());
    CHECK(has_warning(scene, "points and lines"));
  }
}

TEST_CASE("interleaved vertices, offsets, and normalised and plain integers") {
  // 20 bytes per vertex: uv as two normalised u16, a position of 3 floats, 4 unused bytes.
  std::string bytes(8, 'x');
  const std::vector<std::vector<float>> positions{{0, 0, 0}, {2, 0, 0}, {0, 2, 0}};
  for (size_t i = 0; i < 3; ++i)
    bytes += bytes_of<uint16_t>({uint16_t(i == 1 ? 65535 : 0), uint16_t(i == 2 ? 65535 : 0)}) +
             bytes_of<float>(positions[i]) + "....";
  const std::string data =
      "'buffers':[" + data_buffer(bytes) +
      "],'bufferViews':[{'buffer':0,'byteOffset':8,'byteLength':60,'byteStride':20}],"
      "'accessors':[{'bufferView':0,'byteOffset':4,'componentType':5126,'count':3,'type':'VEC3'},"
      "{'bufferView':0,'componentType':5123,'normalized':true,'count':3,'type':'VEC2'}]";
  Scene scene = import_text(one_primitive(data, "{'attributes':{'POSITION':0,'TEXCOORD_0':1}}"));
  REQUIRE(scene.meshes.size() == 1);
  CHECK(scene.meshes[0].positions[1] == Vec3{2, 0, 0});
  CHECK(scene.meshes[0].uvs[1] == Vec2{1, 0});
  CHECK(scene.meshes[0].uvs[2] == Vec2{0, 1});

  // The same 12 bytes as signed bytes, plain and normalised.
  const std::string small = bytes_of<int8_t>({0, 0, 0, 0, 127, 0, 0, 0, 0, -128, 0, 0});
  for (const bool is_normalized : {false, true}) {
    scene = import_text(one_primitive(
        "'buffers':[" + data_buffer(small) +
            "],'bufferViews':[{'buffer':0,'byteLength':12,'byteStride':4}],'accessors':["
            "{'bufferView':0,'componentType':5120,'count':3,'type':'VEC3','normalized':" +
            (is_normalized ? "true" : "false") + "}]",
        "{'attributes':{'POSITION':0}}"));
    CHECK(scene.meshes[0].positions[1].x == (is_normalized ? 1.0f : 127.0f));
    CHECK(scene.meshes[0].positions[2].y == (is_normalized ? -1.0f : -128.0f));
  }
}

TEST_CASE("index types of 8, 16 and 32 bits; an index out of range is an error") {
  const std::string points = bytes_of<float>({0, 0, 0, 1, 0, 0, 0, 1, 0});
  const auto scene_with = [&](const std::string& indices, const char* type) {
    return one_primitive(
        "'buffers':[" + data_buffer(points + indices) +
            "],'bufferViews':[{'buffer':0,'byteLength':36},{'buffer':0,'byteOffset':36,"
            "'byteLength':" +
            std::to_string(indices.size()) +
            "}],'accessors':[{'bufferView':0,'componentType':5126,'count':3,'type':'VEC3'},"
            "{'bufferView':1,'count':3,'type':'SCALAR','componentType':" +
            type + "}]",
        "{'attributes':{'POSITION':0},'indices':1}");
  };
  for (const auto& [bytes, type] : {std::pair{bytes_of<uint8_t>({2, 0, 1}), "5121"},
                                    std::pair{bytes_of<uint16_t>({2, 0, 1}), "5123"},
                                    std::pair{bytes_of<uint32_t>({2, 0, 1}), "5125"}})
    CHECK(import_text(scene_with(bytes, type)).meshes[0].triangles[0] == Triangle{2, 0, 1});
  CHECK(error_of(scene_with(bytes_of<uint16_t>({2, 0, 3}), "5123")).reason().find("index 3") !=
        std::string::npos);
  error_of(scene_with(bytes_of<float>({2, 0, 1}), "5126"));
  error_of(scene_with(bytes_of<uint16_t>({2, 0, 1}), "5125"));  // three do not fit
}

TEST_CASE("sparse accessors, with and without a base; accessors of zeros") {
  const std::string base = bytes_of<float>({0, 0, 0, 1, 0, 0, 0, 1, 0});
  const std::string bytes = base + bytes_of<uint16_t>({1, 2}) + bytes_of<float>({5, 0, 0, 0, 7, 0});
  const auto scene_with = [&](const std::string& view, const std::string& sparse_count) {
    return one_primitive(
        "'buffers':[" + data_buffer(bytes) +
            "],'bufferViews':[{'buffer':0,'byteLength':36},{'buffer':0,'byteOffset':36,"
            "'byteLength':4},{'buffer':0,'byteOffset':40,'byteLength':24}],'accessors':[{" +
            view +
            "'componentType':5126,'count':3,'type':'VEC3','sparse':{'count':" + sparse_count +
            ",'indices':{'bufferView':1,'componentType':5123},'values':{'bufferView':2}}}]",
        "{'attributes':{'POSITION':0}}");
  };
  for (const std::string view : {"'bufferView':0,", ""}) {
    const Scene scene = import_text(scene_with(view, "2"));
    REQUIRE(scene.meshes.size() == 1);
    CHECK(scene.meshes[0].positions[0] == Vec3{0, 0, 0});
    CHECK(scene.meshes[0].positions[1] == Vec3{5, 0, 0});
    CHECK(scene.meshes[0].positions[2] == Vec3{0, 7, 0});
  }
  const Scene one = import_text(scene_with("'bufferView':0,", "1"));
  CHECK(one.meshes[0].positions[1] == Vec3{5, 0, 0});
  CHECK(one.meshes[0].positions[2] == Vec3{0, 1, 0});
  error_of(scene_with("", "3"));  // does not fit into its views
  error_of(scene_with("", "4"));  // more than the accessor has

  const Scene zeros =
      import_text(one_primitive("'accessors':[{'componentType':5126,'count':3000,'type':'VEC3'}]",
                                "{'attributes':{'POSITION':0}}"));
  CHECK(zeros.meshes.empty());
  CHECK(has_warning(zeros, "without area"));
}

TEST_CASE("counts and offsets beyond the data are errors, however large") {
  const auto with = [](const std::string& accessor, const std::string& view) {
    const std::string bytes = bytes_of<float>({0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 2, 3, 4, 5, 6, 7});
    return gltf_text("'buffers':[" + data_buffer(bytes) + "],'bufferViews':[{" + view +
                     "}],'accessors':[{'bufferView':0,'componentType':5126,'type':'VEC3'," +
                     accessor +
                     "}],'meshes':[{'primitives':[{'attributes':{'POSITION':0}}]}],"
                     "'nodes':[{'mesh':0}]");
  };
  const std::string view = "'buffer':0,'byteLength':60";
  CHECK(import_text(with("'count':5", view)).meshes.size() == 1);
  for (const char* const accessor :
       {"'count':6", "'count':4294967295", "'count':18446744073709551615",
        "'count':1,'byteOffset':49", "'count':1,'byteOffset':18446744073709551615",
        "'count':2,'byteOffset':9223372036854775807", "'count':357913942",
        "'count':1537228672809129302"}) {
    CAPTURE(accessor);
    error_of(with(accessor, view));
  }
  for (const char* const bad_view :
       {"'buffer':0,'byteLength':65", "'buffer':0,'byteLength':60,'byteOffset':5",
        "'buffer':0,'byteLength':18446744073709551615,'byteOffset':2",
        "'buffer':0,'byteLength':60,'byteStride':253", "'buffer':0,'byteLength':60,'byteStride':4",
        "'buffer':1,'byteLength':60", "'buffer':0"}) {
    CAPTURE(bad_view);
    error_of(with("'count':1", bad_view));
  }
  error_of(gltf_text("'buffers':[{'byteLength':5,'uri':'data:;base64,AAAA'}]"));
  // Zeros take no space in a file and must not take memory either.
  error_of(one_primitive("'accessors':[{'componentType':5126,'count':4294967295,'type':'VEC3'}]",
                         "{'attributes':{'POSITION':0}}"));
  error_of(
      one_primitive("'accessors':[{'componentType':5126,'count':3,'type':'VEC3'},"
                    "{'componentType':5125,'count':4294967295,'type':'SCALAR'}]",
                    "{'attributes':{'POSITION':0},'indices':1}"));
}

TEST_CASE("a small file cannot ask for endless triangles") {
  std::string nodes;
  for (int i = 0; i < 100; ++i) nodes += "{'mesh':0},";
  const InputError e = error_of(gltf_text(
      "'accessors':[{'componentType':5126,'count':3,'type':'VEC3'},{'componentType':5121,"
      "'count':4000000,'type':'SCALAR'}],'meshes':[{'primitives':[{'attributes':{'POSITION':0},"
      "'indices':1}]}],'nodes':[" +
      nodes + "{}]"));
  CHECK(e.reason().find("triangles") != std::string::npos);
}

TEST_CASE("GLB: chunks, extra data, and every cut") {
  const std::string square = square_bytes();
  std::string json = square_scene("[{'mesh':0}]", "'materials':[{}]");
  const size_t first = json.find("[{\"byteLength\""), last = json.find(']', first);
  json.replace(first, last - first, "[{\"byteLength\":" + std::to_string(square.size()) + "}");
  const std::string chunks = chunk("JSON", json) + chunk(std::string("BIN\0", 4), square);
  const std::string good = glb(chunks);
  CHECK(import_bytes("a.glb", good).meshes.size() == 1);
  CHECK(import_bytes("a.GLTF", good).meshes.size() == 1);  // recognised by content
  CHECK(import_bytes("a.glb", good + "more").meshes.size() == 1);
  CHECK(import_bytes("a.glb", glb(chunks + chunk("ABCD", "1234"))).meshes.size() == 1);
  const TempFolder folder;
  for (size_t size = 0; size < good.size(); size += size < 64 ? 1 : 13)
    CHECK_THROWS_AS(import_gltf(folder.write("a.glb", good.substr(0, size))), InputError);
  const Scene late = import_bytes("a.glb", glb(chunk("JSON", json) + chunk("ABCD", "1234") +
                                               chunk(std::string("BIN\0", 4), square)));
  CHECK(has_warning(late, "not the second one"));
  CHECK_THROWS_AS(import_bytes("a.glb", glb(chunk("JSON", json))), InputError);  // no data
  CHECK_THROWS_AS(import_bytes("a.glb", glb(chunks + chunk("JSON", json))), InputError);
  CHECK_THROWS_AS(import_bytes("a.glb", glb(chunk(std::string("BIN\0", 4), square))), InputError);
  CHECK_THROWS_AS(import_bytes("a.glb", json), InputError);
  std::string other_version = good;
  other_version[4] = 1;
  CHECK_THROWS_AS(import_bytes("a.glb", other_version), InputError);
}

TEST_CASE("flipped bytes anywhere give a scene or InputError") {
  const std::string good = square_scene("[{'mesh':0}]", "'materials':[{'emissiveFactor':[1,1,1]}]");
  const TempFolder folder;
  uint32_t state = 1;
  for (int trial = 0; trial < 1000; ++trial) {
    std::string bad = good;
    for (int k = 0; k < 1 + trial % 3; ++k) {
      state = state * 1664525u + 1013904223u;
      const size_t at = (state >> 8) % bad.size();
      bad[at] = "0123456789-\",:[]{}x\xff"[(state >> 3) % 20];
    }
    const std::string path = folder.write("scene.gltf", bad);
    try {
      import_gltf(path);
    } catch (const InputError& e) {
      CHECK(std::string(e.what()).find('\n') == std::string::npos);
    }
  }
}

TEST_CASE("external buffers: percent-decoding, and no way out of the folder") {
  const TempFolder folder;
  std::filesystem::create_directories(folder.path("inner/data"));
  folder.write("inner/data/my square.bin", square_bytes());
  folder.write("outside.bin", square_bytes());
  std::filesystem::create_symlink(folder.path("outside.bin"), folder.path("inner/link.bin"));
  const std::string good = square_scene("[{'mesh':0}]", "'materials':[{}]");
  const size_t first = good.find("data:"), last = good.find('"', first);
  const auto with_uri = [&](const std::string& uri) {
    std::string text = good;
    return folder.write("inner/scene.gltf", text.replace(first, last - first, uri));
  };
  CHECK(import_gltf(with_uri("data/my%20square.bin")).meshes.size() == 1);
  CHECK(import_gltf(with_uri("data/../data/my square.bin")).meshes.size() == 1);
  for (const std::string uri :
       {"../outside.bin", "data/../../outside.bin", "%2e%2e/outside.bin", "..%2Foutside.bin",
        "link.bin", "", ".", "data", "nothing.bin", "data/my%2", "data/my%zz.bin", "a%00b",
        "http://example.org/a.bin", "file:///etc/passwd", "/etc/passwd", "data:,x",
        "data:;base64,*", "data:nothing"}) {
    CAPTURE(uri);
    CHECK_THROWS_AS(import_gltf(with_uri(uri)), InputError);
  }
  CHECK_THROWS_AS(import_gltf(with_uri(folder.path("outside.bin"))), InputError);
  try {
    import_gltf(with_uri("../outside.bin"));
  } catch (const InputError& e) {
    CHECK(e.reason().find("leads out of") != std::string::npos);
    CHECK(e.line() == 2);
  }
}

TEST_CASE("vertices that are not finite, and normals without direction") {
  const float inf = std::numeric_limits<float>::infinity();
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const std::string bytes =
      bytes_of<float>({0, 0, 0, 1, 0, 0, 0, 1, 0, inf, 0, 0, 1, 0, nan, 0, 1e30f, 0}) +
      bytes_of<uint16_t>({0, 1, 2, 0, 1, 3, 1, 2, 4, 1, 2, 5, 1, 1, 2, 0}) +
      bytes_of<float>({0, 0, 0, nan, 0, 1, 0, 0, 9, 0, 0, 1, 0, 0, 1, 0, 0, 1});
  const Scene scene = import_text(one_primitive(
      "'buffers':[" + data_buffer(bytes) +
          "],'bufferViews':[{'buffer':0,'byteLength':72},{'buffer':0,'byteOffset':72,"
          "'byteLength':30},{'buffer':0,'byteOffset':104,'byteLength':72}],'accessors':["
          "{'bufferView':0,'componentType':5126,'count':6,'type':'VEC3'},"
          "{'bufferView':1,'componentType':5123,'count':15,'type':'SCALAR'},"
          "{'bufferView':2,'componentType':5126,'count':6,'type':'VEC3'}]",
      "{'attributes':{'POSITION':0,'NORMAL':2},'indices':1}"));
  REQUIRE(scene.meshes.size() == 1);
  CHECK(scene.meshes[0].triangles.size() == 1);
  CHECK(scene.meshes[0].positions.size() == 3);
  for (const Vec3& n : scene.meshes[0].normals) CHECK(n == Vec3{0, 0, 1});
  REQUIRE(scene.warnings.entries().size() == 2);
  CHECK(scene.warnings.entries()[0].count == 3);
  CHECK(scene.warnings.entries()[1].count == 1);
}

}  // namespace test_gltf_data
