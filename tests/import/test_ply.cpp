// Tests of PLY files: one mesh in many encodings, and invalid files.
#include <doctest/doctest.h>

#include <cstring>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/random.h"
#include "import/mesh/ply.h"
#include "temp_folder.h"

using namespace troffer;

namespace test_ply {

namespace {

Mesh read_text(const std::string& text, WarningLog* log = nullptr) {
  const TempFolder folder;
  WarningLog ignored;
  return read_ply(folder.write("m.ply", text), log ? *log : ignored).mesh;
}

// Returns the bytes of a scalar in either order.
template <class T>
std::string bytes_of(T value, bool is_big) {
  std::string out(sizeof(T), '\0');
  std::memcpy(out.data(), &value, sizeof(T));
  if (is_big) out = std::string(out.rbegin(), out.rend());
  return out;
}

// Returns a quad and a triangle with normals and (u,v), unusual types, extra properties and
// elements, and faces before vertices.
std::string binary_file(bool is_big) {
  std::string s = std::string("ply\nformat binary_") + (is_big ? "big" : "little") +
                  "_endian 1.0\ncomment hello\nelement face 2\nproperty uchar flag\n"
                  "property list ushort int vertex_indices\nproperty list uchar double extra\n"
                  "element junk 2\nproperty short a\nproperty list int8 float b\n"
                  "element vertex 5\nproperty double z\nproperty float y\nproperty short x\n"
                  "property list uchar uchar tags\nproperty float nx\nproperty float ny\n"
                  "property float nz\nproperty float texture_v\nproperty float texture_u\n"
                  "end_header\n";
  const auto put = [&](auto value) { s += bytes_of(value, is_big); };
  put(uint8_t(1));
  put(uint16_t(4));
  for (const int i : {0, 1, 2, 3}) put(int32_t(i));
  put(uint8_t(1));
  put(2.5);
  put(uint8_t(0));
  put(uint16_t(3));
  for (const int i : {0, 1, 4}) put(int32_t(i));
  put(uint8_t(0));
  for (int i = 0; i < 2; ++i) {
    put(int16_t(-7));
    put(int8_t(1));
    put(1.0f);
  }
  const int xy[5][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}, {-3, -2}};
  for (int i = 0; i < 5; ++i) {
    put(double(i) + 0.5);
    put(float(xy[i][1]));
    put(int16_t(xy[i][0]));
    put(uint8_t(2));
    put(uint8_t(9));
    put(uint8_t(9));
    put(0.0f);
    put(0.0f);
    put(1.0f);
    put(float(i));
    put(float(10 * i));
  }
  return s;
}

const std::string ascii_file =
    "ply\r\nformat ascii 1.0\r\nobj_info x\r\nelement vertex 5\r\nproperty float x\r\n"
    "property float y\r\nproperty float z\r\nproperty float nx\r\nproperty float ny\r\n"
    "property float nz\r\nproperty float u\r\nproperty float v\r\nelement face 2\r\n"
    "property list uchar uint vertex_index\r\nend_header\r\n"
    "0 0 .5 0 0 1 0 0\r\n1 0 1.5 0 0 1 10 1\r\n+1 1e0 2.5 0 0 1 20 2\r\n0 1 3.5 0 0 1 30 3\r\n"
    "-3 -2 4.5 0 0 1 40 4\r\n4 0 1 2 3\r\n3 0 1 4";

void check_mesh(const Mesh& m) {
  REQUIRE(m.positions.size() == 5);
  CHECK(m.positions[2] == Vec3(1, 1, 2.5f));
  CHECK(m.positions[4] == Vec3(-3, -2, 4.5f));
  REQUIRE(m.normals.size() == 5);
  CHECK(m.normals[4] == Vec3(0, 0, 1));
  REQUIRE(m.uvs.size() == 5);
  CHECK(m.uvs[3] == Vec2(30, 3));
  REQUIRE(m.triangles.size() == 3);
  CHECK(m.triangles[0] == Triangle{0, 1, 2});
  CHECK(m.triangles[1] == Triangle{0, 2, 3});
  CHECK(m.triangles[2] == Triangle{0, 1, 4});
}

struct Failure {
  int line = -1, column = -1;
};
Failure failure_of(const std::string& text) {
  try {
    read_text(text);
  } catch (const InputError& e) {
    return {e.line(), e.column()};
  }
  return {};
}

}  // namespace

TEST_CASE("one mesh in three encodings") {
  WarningLog log;
  check_mesh(read_text(ascii_file, &log));
  CHECK(log.entries().empty());
  check_mesh(read_text(binary_file(false), &log));
  CHECK(log.total() == 1);  // the skipped element
  check_mesh(read_text(binary_file(true)));
}

TEST_CASE("PLY files cut off anywhere are errors") {
  for (const std::string& whole : {ascii_file, binary_file(false)}) {
    for (size_t n = 0; n < whole.size() - 1; ++n) {
      const std::string cut = whole.substr(0, n);
      // An ascii file without its last digits may still be complete; here the index 4 is the last
      // byte.
      CAPTURE(n);
      CHECK_THROWS_AS(read_text(cut), InputError);
    }
  }
}

TEST_CASE("false counts do not make the reader allocate") {
  const std::string vertex = "property float x\nproperty float y\nproperty float z\n";
  const std::string face = "property list uchar int vertex_indices\n";
  for (const char* format : {"ascii", "binary_little_endian", "binary_big_endian"}) {
    const std::string start = std::string("ply\nformat ") + format + " 1.0\n";
    for (const char* count : {"1000000000", "4000000000", "18446744073709551615"}) {
      CHECK_THROWS_AS(read_text(start + "element vertex " + count + "\n" + vertex +
                                "element face 0\n" + face + "end_header\n0 0 0\n"),
                      InputError);
      CHECK_THROWS_AS(read_text(start + "element face " + count + "\n" + face +
                                "element vertex 0\n" + vertex + "end_header\n0 0 0\n"),
                      InputError);
    }
  }
  // A list that claims four billion entries.
  CHECK_THROWS_AS(read_text("ply\nformat binary_little_endian 1.0\nelement face 1\nproperty list "
                            "uint int vertex_indices\nelement vertex 0\n" +
                            vertex + "end_header\n\xff\xff\xff\xff"),
                  InputError);
  // Elements without properties need no data, however many there are.
  const Mesh empty = read_text(
      "ply\nformat ascii 1.0\nelement ghost 18446744073709551615\n"
      "element vertex 0\n" +
      vertex + "end_header\n");
  CHECK(empty.triangles.empty());
}

TEST_CASE("errors in PLY files have their places") {
  const std::string header =
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
      "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n";
  const std::string vertices = "0 0 0\n1 0 0\n0 1 0\n";
  const auto check = [&](const std::string& text, int line, int column) {
    CAPTURE(text);
    const Failure failure = failure_of(text);
    CHECK(failure.line == line);
    CHECK(failure.column == column);
  };
  check(header + vertices + "3 0 1 3\n", 13, 7);
  check(header + vertices + "3 0 1 -1\n", 13, 7);
  check(header + vertices + "3 0 1 x\n", 13, 7);
  check(header + vertices + "3 0 1 1.5\n", 13, 7);
  check(header + vertices + "-3 0 1 1\n", 13, 1);
  check(header + "0 0 0\n1 zero 0\n0 1 0\n3 0 1 2\n", 11, 3);
  check("plx\n", 1, 1);
  check("ply\nformat ascii 2.0\n", 2, 14);
  check("ply\nformat ascii 1.0\nelement vertex many\n", 3, 16);
  check("ply\nformat ascii 1.0\nelement vertex 1\nproperty half x\n", 4, 10);
  check("ply\nformat ascii 1.0\nproperty float x\n", 3, 1);
  check("ply\nformat ascii 1.0\nelement face 1\nproperty list float int i\n", 4, 15);
  check("ply\nformat ascii 1.0\nbogus\n", 3, 1);
  // Index lists of floats, and meshes without coordinates.
  CHECK_THROWS_AS(read_text("ply\nformat ascii 1.0\nelement vertex 0\nproperty float x\nproperty "
                            "float y\nend_header\n"),
                  InputError);
  CHECK_THROWS_AS(read_text("ply\nformat ascii 1.0\nelement vertex 0\nproperty float x\nproperty "
                            "float y\nproperty float z\nelement face 0\nproperty list int float "
                            "vertex_indices\nend_header\n"),
                  InputError);
}

TEST_CASE("odd but harmless PLY files") {
  const std::string header =
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
      "property float z\nelement face 2\nproperty list uchar int vertex_indices\nend_header\n";
  WarningLog log;
  const Mesh mesh = read_text(header + "nan 0 0\n1 -inf 0\n0 1e99 0\n2 0 1\n3 0 1 2\n", &log);
  CHECK(mesh.triangles.size() == 1);
  CHECK(std::isnan(mesh.positions[0].x));
  CHECK(std::isinf(mesh.positions[2].y));
  CHECK(log.total() == 1);  // the face of two vertices
}

TEST_CASE("damaged PLY files load or fail cleanly") {
  Random random(11);
  const TempFolder folder;
  for (const std::string& whole : {ascii_file, binary_file(false), binary_file(true)}) {
    for (int round = 0; round < 700; ++round) {
      std::string damaged = whole;
      for (int e = 0; e < 3; ++e)
        damaged[random.next_u32() % damaged.size()] = char(random.next_u32());
      try {
        WarningLog log;
        const Mesh mesh = read_ply(folder.write("m.ply", damaged), log).mesh;
        for (const Triangle& t : mesh.triangles)
          for (const uint32_t v : t) REQUIRE(v < mesh.positions.size());
      } catch (const InputError&) {
      }
    }
  }
}

}  // namespace test_ply
