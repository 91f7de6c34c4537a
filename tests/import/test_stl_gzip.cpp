// Tests of STL files, and of scenes that are compressed as a whole.
#include <doctest/doctest.h>
#include <zlib.h>

#include <cstring>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/random.h"
#include "import/file.h"
#include "import/import.h"
#include "import/mesh_clean.h"
#include "temp_folder.h"

using namespace troffer;

namespace test_stl_gzip {

namespace {

std::string gzipped(const std::string& text) {
  z_stream stream{};
  REQUIRE(deflateInit2(&stream, 9, Z_DEFLATED, 15 + 16, 9, Z_DEFAULT_STRATEGY) == Z_OK);
  std::string in = text, out(deflateBound(&stream, uLong(text.size())) + 64, '\0');
  stream.next_in = reinterpret_cast<Bytef*>(in.data());
  stream.avail_in = uInt(in.size());
  stream.next_out = reinterpret_cast<Bytef*>(out.data());
  stream.avail_out = uInt(out.size());
  REQUIRE(deflate(&stream, Z_FINISH) == Z_STREAM_END);
  out.resize(stream.total_out);
  deflateEnd(&stream);
  return out;
}

std::string binary_stl(const std::vector<float>& corners) {
  std::string out(80, 's');
  const auto n = uint32_t(corners.size() / 9);
  const auto append = [&](const void* data, size_t size) {
    out.append(static_cast<const char*>(data), size);
  };
  append(&n, 4);
  for (uint32_t i = 0; i < n; ++i) {
    out.append(12, '\0');
    append(&corners[9 * i], 36);
    out.append(2, '\0');
  }
  return out;
}

const std::string text_stl =
    "solid a name\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 1 1 0\n"
    "endloop\nendfacet\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1e0 1 0\n"
    "vertex 0 1 0\nendloop\nendfacet\nendsolid a name\n";

std::string reason_of(const std::string& path) {
  try {
    import_scene(path);
  } catch (const InputError& e) {
    return e.reason();
  }
  return "";
}

}  // namespace

TEST_CASE("STL: text and binary, corners that meet are one vertex") {
  const TempFolder folder;
  const std::string binary = binary_stl({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 0, 0, 1, 1, 0, 0, 1, 0});
  for (const std::string& file : {text_stl, binary}) {
    const Scene scene = import_scene(folder.write("a.STL", file));
    REQUIRE(scene.meshes.size() == 1);
    CHECK(scene.meshes[0].triangles.size() == 2);
    CHECK(scene.meshes[0].positions.size() == 4);
    CHECK(area_of(scene.meshes[0]) == doctest::Approx(1));
    CHECK(area_vector(scene.meshes[0], scene.meshes[0].triangles[0]).z > 0);
    CHECK(scene.materials.size() == 1);
  }
  CHECK(reason_of(folder.write("a.stl", binary.substr(0, 180))).find("too short") !=
        std::string::npos);
  CHECK(reason_of(folder.write("a.stl", "solid\nfacet\nvertex 1 2\n")).find("number") !=
        std::string::npos);
  CHECK(reason_of(folder.write("a.stl", "solid\nvertex 1 2 3\nendfacet\n")).find("three") !=
        std::string::npos);
  Random random(3);
  for (int trial = 0; trial < 600; ++trial) {
    std::string bad = trial % 2 == 0 ? text_stl : binary;
    for (int k = 0; k < 3; ++k) bad[random.next_u32() % bad.size()] = char(random.next_u32());
    reason_of(folder.write("a.stl", bad));
  }
}

TEST_CASE("files that end in .gz are decompressed: scenes, and meshes that they name") {
  const TempFolder folder;
  const std::string obj = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
  CHECK(import_scene(folder.write("a.obj.gz", gzipped(obj))).meshes.size() == 1);
  folder.write("m.ply.gz", gzipped("ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\n"
                                   "property float y\nproperty float z\nelement face 1\n"
                                   "property list uchar int vertex_indices\nend_header\n"
                                   "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"));
  folder.write("inner.pbrt.gz", gzipped("Shape \"plymesh\" \"string filename\" \"m.ply.gz\"\n"));
  CHECK(import_scene(folder.write("s.pbrt", "WorldBegin\nInclude \"inner.pbrt.gz\"\n"))
            .meshes.size() == 1);
  // Consecutive gzip members form one text.
  CHECK(read_text_file(folder.write("two.gz", gzipped("one ") + gzipped("two"))) == "one two");
}

TEST_CASE("compressed files that are cut, damaged or too large are errors") {
  const TempFolder folder;
  const std::string whole = gzipped("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  for (size_t n = 1; n < whole.size(); ++n)
    CHECK_FALSE(reason_of(folder.write("a.obj.gz", whole.substr(0, n))).empty());
  std::string bad = whole;
  bad[whole.size() / 2] = char(bad[whole.size() / 2] ^ 0x55);
  CHECK(reason_of(folder.write("a.obj.gz", bad)).find("broken") != std::string::npos);
  CHECK(reason_of(folder.write("a.obj.gz", "plain text")).find("broken") != std::string::npos);
  const std::string bomb = folder.write("b.gz", gzipped(std::string(1 << 20, ' ')));
  CHECK(read_text_file(bomb).size() == 1 << 20);
  CHECK_THROWS_AS(read_text_file(bomb, 100'000), InputError);
}

TEST_CASE("a PLY file is a scene of one grey mesh") {
  const TempFolder folder;
  const std::string head =
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float "
      "z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n";
  const Scene scene = import_scene(folder.write("a.ply", head + "0 0 0\n2 0 0\n0 1 0\n3 0 1 2\n"));
  REQUIRE(scene.meshes.size() == 1);
  CHECK(area_of(scene.meshes[0]) == doctest::Approx(1));
  CHECK(scene.lights.empty());
  // Far from the origin, where floats are coarse.
  const Scene far = import_scene(
      folder.write("b.ply", head + "90000000 0 0\n90000002 0 0\n90000000 1 0\n3 0 1 2\n"));
  CHECK(far.origin.x != 0);
  CHECK(reason_of(folder.write("c.ply", "plywood")) != "");
}

}  // namespace test_stl_gzip
