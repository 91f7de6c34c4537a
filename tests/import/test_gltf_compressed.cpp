// Tests of compressed geometry and images in glTF files: meshopt, Draco, WebP.
#include <draco/compression/encode.h>
#include <draco/mesh/triangle_soup_mesh_builder.h>
#include <meshoptimizer.h>
#include <webp/encode.h>

#include <array>
#include <functional>

#include "import/gltf_builder.h"

using namespace troffer;

namespace test_gltf_compressed {

namespace {

std::string as_string(const std::vector<unsigned char>& bytes) {
  return {bytes.begin(), bytes.end()};
}

std::string encoded_vertices(const std::string& data, size_t stride) {
  const size_t n = data.size() / stride;
  std::vector<unsigned char> out(meshopt_encodeVertexBufferBound(n, stride));
  out.resize(meshopt_encodeVertexBuffer(out.data(), out.size(), data.data(), n, stride));
  return as_string(out);
}
std::string encoded_triangles(const std::vector<unsigned>& indices, size_t vertices) {
  std::vector<unsigned char> out(meshopt_encodeIndexBufferBound(indices.size(), vertices));
  out.resize(meshopt_encodeIndexBuffer(out.data(), out.size(), indices.data(), indices.size()));
  return as_string(out);
}
std::string encoded_sequence(const std::vector<unsigned>& indices, size_t vertices) {
  std::vector<unsigned char> out(meshopt_encodeIndexSequenceBound(indices.size(), vertices));
  out.resize(meshopt_encodeIndexSequence(out.data(), out.size(), indices.data(), indices.size()));
  return as_string(out);
}

std::string padded(std::string bytes) {
  bytes.resize((bytes.size() + 3) / 4 * 4);
  return bytes;
}

// The unit square: float positions, normals through the octahedral filter, 16-bit indices.
struct MeshoptSquare {
  std::string positions, normals, indices, mode = "TRIANGLES";

  MeshoptSquare() {
    positions = encoded_vertices(bytes_of<float>({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0}), 12);
    const std::vector<float> up{0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0};
    std::string filtered(16, '\0');
    meshopt_encodeFilterOct(filtered.data(), 4, 4, 8, up.data());
    normals = encoded_vertices(filtered, 4);
    indices = encoded_triangles({0, 1, 2, 0, 2, 3}, 4);
  }

  std::string text() const {
    const std::string data = padded(positions) + padded(normals) + padded(indices);
    const auto view = [&](size_t length, size_t at, size_t size, size_t stride, size_t count,
                          const std::string& more, size_t view_stride) {
      return "{'buffer':1,'byteLength':" + std::to_string(length) +
             (view_stride > 0 ? ",'byteStride':" + std::to_string(view_stride) : std::string()) +
             ",'extensions':{'EXT_meshopt_compression':{'buffer':0,'byteOffset':" +
             std::to_string(at) + ",'byteLength':" + std::to_string(size) +
             ",'byteStride':" + std::to_string(stride) + ",'count':" + std::to_string(count) + "," +
             more + "}}}";
    };
    const size_t a = padded(positions).size(), b = a + padded(normals).size();
    return gltf_text(
        "'extensionsRequired':['EXT_meshopt_compression','KHR_mesh_quantization'],'buffers':[" +
        data_buffer(data) +
        ",{'byteLength':76,'extensions':{'EXT_meshopt_compression':{'fallback':true}}}],"
        "'bufferViews':[" +
        view(48, 0, positions.size(), 12, 4, "'mode':'ATTRIBUTES'", 12) + "," +
        view(16, a, normals.size(), 4, 4, "'mode':'ATTRIBUTES','filter':'OCTAHEDRAL'", 4) + "," +
        view(12, b, indices.size(), 2, 6, "'mode':'" + mode + "'", 0) +
        "],'accessors':[{'bufferView':0,'componentType':5126,'count':4,'type':'VEC3'},"
        "{'bufferView':1,'componentType':5120,'normalized':true,'count':4,'type':'VEC3'},"
        "{'bufferView':2,'componentType':5123,'count':6,'type':'SCALAR'}],"
        "'meshes':[{'primitives':[{'attributes':{'POSITION':0,'NORMAL':1},'indices':2}]}],"
        "'nodes':[{'mesh':0}]");
  }
};

void check_square(const Scene& scene) {
  REQUIRE(scene.meshes.size() == 1);
  const Mesh& m = scene.meshes[0];
  CHECK(m.triangles.size() == 2);
  CHECK(m.positions.size() == 4);
  double area = 0;
  for (const Triangle& t : m.triangles) {
    const Vec3 n =
        cross(m.positions[t[1]] - m.positions[t[0]], m.positions[t[2]] - m.positions[t[0]]);
    area += double(n.z) / 2;
  }
  CHECK(area == doctest::Approx(1).epsilon(1e-3));
  REQUIRE(m.normals.size() == 4);
  for (const Vec3& n : m.normals) CHECK(n.z > 0.999f);
}

// Returns a compressed grid of n × n squares over the unit square, with normals and (u,v) = (x,y).
std::string draco_grid(int n, int method) {
  draco::TriangleSoupMeshBuilder builder;
  builder.Start(n * n * 2);
  const int position =
      builder.AddAttribute(draco::GeometryAttribute::POSITION, 3, draco::DT_FLOAT32);
  const int normal = builder.AddAttribute(draco::GeometryAttribute::NORMAL, 3, draco::DT_FLOAT32);
  const int uv = builder.AddAttribute(draco::GeometryAttribute::TEX_COORD, 2, draco::DT_FLOAT32);
  const std::array<float, 3> up{0, 0, 1};
  uint32_t face = 0;
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i)
      for (const auto& corners : {std::array{0, 1, 3}, std::array{0, 3, 2}}) {
        std::array<std::array<float, 3>, 3> p{};
        for (size_t k = 0; k < 3; ++k)
          p[k] = {float(i + corners[k] % 2) / float(n), float(j + corners[k] / 2) / float(n), 0};
        const draco::FaceIndex f(face++);
        builder.SetAttributeValuesForFace(position, f, p[0].data(), p[1].data(), p[2].data());
        builder.SetAttributeValuesForFace(normal, f, up.data(), up.data(), up.data());
        builder.SetAttributeValuesForFace(uv, f, p[0].data(), p[1].data(), p[2].data());
      }
  const auto mesh = builder.Finalize();
  draco::Encoder encoder;
  encoder.SetEncodingMethod(method);
  encoder.SetAttributeQuantization(draco::GeometryAttribute::POSITION, 14);
  encoder.SetAttributeQuantization(draco::GeometryAttribute::TEX_COORD, 12);
  encoder.SetAttributeQuantization(draco::GeometryAttribute::NORMAL, 10);
  draco::EncoderBuffer buffer;
  REQUIRE(encoder.EncodeMeshToBuffer(*mesh, &buffer).ok());
  return {buffer.data(), buffer.size()};
}

std::string draco_text(const std::string& data, int vertices, int triangles,
                       const std::string& ids = "'POSITION':0,'NORMAL':1,'TEXCOORD_0':2") {
  const std::string n = std::to_string(vertices), corners = std::to_string(3 * triangles);
  return gltf_text(
      "'extensionsUsed':['KHR_draco_mesh_compression'],'extensionsRequired':["
      "'KHR_draco_mesh_compression'],'buffers':[" +
      data_buffer(data) + "],'bufferViews':[{'buffer':0,'byteLength':" +
      std::to_string(data.size()) + "}],'accessors':[{'componentType':5126,'count':" + n +
      ",'type':'VEC3'},{'componentType':5126,'count':" + n +
      ",'type':'VEC3'},{'componentType':5126,'count':" + n +
      ",'type':'VEC2'},{'componentType':5125,'count':" + corners +
      ",'type':'SCALAR'}],'meshes':[{'primitives':[{'attributes':{'POSITION':0,'NORMAL':1,"
      "'TEXCOORD_0':2},'indices':3,'extensions':{'KHR_draco_mesh_compression':{'bufferView':0,"
      "'attributes':{" +
      ids + "}}}}]}],'nodes':[{'mesh':0}]");
}

void check_mutations(const std::string& good,
                     const std::function<std::string(const std::string&)>& text_of, int trials) {
  const TempFolder folder;
  uint32_t state = 7;
  const auto next = [&] { return (state = state * 1664525u + 1013904223u) >> 8; };
  int errors = 0;
  for (int trial = 0; trial < trials; ++trial) {
    std::string bad = good;
    for (int k = 0; k < 1 + trial % 3; ++k) bad[next() % bad.size()] = char(next());
    if (trial % 5 == 0) bad.resize(next() % bad.size());
    try {
      const Scene scene = import_gltf(folder.write("a.gltf", text_of(bad)));
      for (const Mesh& mesh : scene.meshes)
        for (const Triangle& t : mesh.triangles)
          for (const uint32_t v : t) REQUIRE(v < mesh.positions.size());
    } catch (const InputError& e) {
      ++errors;
      CHECK(std::string(e.what()).find('\n') == std::string::npos);
    }
  }
  CHECK(errors > trials / 20);
}

}  // namespace

TEST_CASE("EXT_meshopt_compression: vertices, filtered normals, triangles and index sequences") {
  MeshoptSquare square;
  const Scene scene = import_text(square.text());
  check_square(scene);
  CHECK(scene.warnings.total() == 0);
  square.mode = "INDICES";
  square.indices = encoded_sequence({0, 1, 2, 0, 2, 3}, 4);
  check_square(import_text(square.text()));
}

TEST_CASE("EXT_meshopt_compression: impossible data is an error at its place") {
  MeshoptSquare square;
  const std::string good = square.text();
  const auto with = [&](const std::string& from, const std::string& to) {
    std::string text = good;
    const size_t at = text.find(from);
    REQUIRE(at != std::string::npos);
    return error_of(text.replace(at, from.size(), to)).reason();
  };
  CHECK(with("\"mode\":\"TRIANGLES\"", "\"mode\":\"BANANAS\"").find("BANANAS") !=
        std::string::npos);
  CHECK(with("OCTAHEDRAL", "CUBIC").find("not a filter") != std::string::npos);
  CHECK(with("OCTAHEDRAL", "QUATERNION").find("filter") != std::string::npos);
  CHECK(with("\"count\":6,\"mode\"", "\"count\":7,\"mode\"").find("count") != std::string::npos);
  CHECK(with("\"buffer\":1,\"byteLength\":48", "\"buffer\":1,\"byteLength\":480000000000")
            .find("too much") != std::string::npos);
  square.positions.resize(square.positions.size() - 4);
  CHECK(error_of(square.text()).reason().find("broken") != std::string::npos);
}

TEST_CASE("EXT_meshopt_compression: damaged data loads or fails cleanly") {
  const MeshoptSquare good;
  check_mutations(
      good.positions + good.indices,
      [&](const std::string& bytes) {
        MeshoptSquare bad = good;
        const size_t n = std::min(bytes.size(), good.positions.size());
        bad.positions = bytes.substr(0, n);
        bad.indices = bytes.substr(n);
        return bad.text();
      },
      500);
}

TEST_CASE("KHR_draco_mesh_compression: both methods, normals and texture coordinates") {
  for (const int method :
       {int(draco::MESH_SEQUENTIAL_ENCODING), int(draco::MESH_EDGEBREAKER_ENCODING)}) {
    CAPTURE(method);
    const Scene scene = import_text(draco_text(draco_grid(8, method), 81, 128));
    REQUIRE(scene.meshes.size() == 1);
    const Mesh& m = scene.meshes[0];
    CHECK(m.triangles.size() == 128);
    CHECK(m.positions.size() == 81);
    double area = 0;
    for (const Triangle& t : m.triangles)
      area +=
          double(cross(m.positions[t[1]] - m.positions[t[0]], m.positions[t[2]] - m.positions[t[0]])
                     .z) /
          2;
    CHECK(area == doctest::Approx(1).epsilon(1e-3));
    REQUIRE(m.normals.size() == 81);
    REQUIRE(m.uvs.size() == 81);
    for (size_t i = 0; i < 81; ++i) {
      CHECK(m.normals[i].z > 0.999f);
      CHECK(m.uvs[i].x == doctest::Approx(m.positions[i].x).epsilon(2e-3));
      CHECK(m.uvs[i].y == doctest::Approx(m.positions[i].y).epsilon(2e-3));
    }
  }
}

TEST_CASE("KHR_draco_mesh_compression: impossible data is an error at its place") {
  const std::string data = draco_grid(4, draco::MESH_EDGEBREAKER_ENCODING);
  CHECK(error_of(draco_text("DRACO nonsense", 25, 32)).reason().find("Draco") != std::string::npos);
  CHECK(error_of(draco_text(data, 25, 32, "'POSITION':9")).reason().find("no attribute 9") !=
        std::string::npos);
  CHECK(error_of(draco_text(data, 25, 32, "'NORMAL':1")).reason().find("no positions") !=
        std::string::npos);
  // Headers that claim four billion triangles.
  for (const int method :
       {int(draco::MESH_SEQUENTIAL_ENCODING), int(draco::MESH_EDGEBREAKER_ENCODING)}) {
    std::string lie = draco_grid(4, method);
    const size_t counts = method == draco::MESH_EDGEBREAKER_ENCODING ? 12 : 11;
    lie.replace(counts, 2, "\xff\xff\xff\xff\x0f\xff\xff\xff\xff\x0f");
    CHECK(error_of(draco_text(lie, 25, 32)).reason().find("Draco") != std::string::npos);
  }
}

TEST_CASE("KHR_draco_mesh_compression: damaged data loads or fails cleanly") {
  for (const int method :
       {int(draco::MESH_SEQUENTIAL_ENCODING), int(draco::MESH_EDGEBREAKER_ENCODING)})
    check_mutations(
        draco_grid(6, method), [](const std::string& bytes) { return draco_text(bytes, 49, 72); },
        500);
}

TEST_CASE("EXT_texture_webp is preferred; for KTX images the plain fallback is shown") {
  const std::array<uint8_t, 12> pixels{255, 0, 0, 0, 255, 0, 0, 0, 255, 255, 255, 255};
  uint8_t* out = nullptr;
  const size_t size = WebPEncodeLosslessRGB(pixels.data(), 2, 2, 6, &out);
  REQUIRE(size > 0);
  const TempFolder folder;
  folder.write("a.webp", std::string(reinterpret_cast<const char*>(out), size));
  WebPFree(out);
  folder.write("b.pfm", "PF\n1 1\n-1.0\n" + bytes_of<float>({1, 0, 0}));
  folder.write("c.ktx2", "\xabKTX 20\xbb\r\n\x1a\n");
  const auto texture_of = [&](const std::string& texture) {
    const Scene scene = import_gltf(folder.write(
        "scene.gltf",
        square_scene("[{'mesh':0}]",
                     "'extensionsRequired':['EXT_texture_webp'],'images':[{'uri':'a.webp'},{'uri':"
                     "'b.pfm'},{'uri':'c.ktx2'}],'textures':[" +
                         texture +
                         "],'materials':[{'pbrMetallicRoughness':{'baseColorTexture':{'index':0"
                         "}}}]")));
    const ColorInput& color = scene.materials.at(0).base_color;
    return color.texture == no_texture ? Texture{} : scene.textures.at(size_t(color.texture));
  };
  const Texture webp = texture_of("{'source':1,'extensions':{'EXT_texture_webp':{'source':0}}}");
  REQUIRE(webp.width == 2);
  CHECK(webp.channels == 3);
  CHECK(webp.is_srgb);
  CHECK(webp.texels8 == std::vector<uint8_t>(pixels.begin(), pixels.end()));
  CHECK(texture_of("{'source':1,'extensions':{'KHR_texture_basisu':{'source':2}}}").width == 1);
  CHECK(texture_of("{'extensions':{'KHR_texture_basisu':{'source':2}}}").width == 0);
}

}  // namespace test_gltf_compressed
