// Tests that reading files in pieces on several threads gives the same meshes, warnings and errors,
// bit for bit, as sequential reading.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <limits>
#include <map>
#include <random>
#include <string>
#include <tuple>
#include <vector>

#include "base/error.h"
#include "base/parallel.h"
#include "import/mesh/obj.h"
#include "import/mesh/ply.h"
#include "import/mesh/stl.h"
#include "import/weld.h"
#include "mutations.h"
#include "temp_folder.h"

using namespace troffer;

namespace test_pieces {

namespace {

std::string bits_of(float x) {
  return fmt::format(" {:x}", std::bit_cast<uint32_t>(x));
}

std::string dump(const Mesh& mesh, const WarningLog& log) {
  std::string out;
  for (const std::vector<Vec3>* vectors : {&mesh.positions, &mesh.normals})
    for (const Vec3& v : *vectors) out += bits_of(v.x) + bits_of(v.y) + bits_of(v.z);
  for (const Vec2& v : mesh.uvs) out += bits_of(v.x) + bits_of(v.y);
  for (const Triangle& t : mesh.triangles) out += fmt::format(" {}/{}/{}", t[0], t[1], t[2]);
  for (const Warning& w : log.entries()) out += fmt::format("\n{} {}", w.text, w.count);
  return out;
}

std::string ply_outcome(const std::string& path, size_t piece_bytes, int threads) {
  const ThreadLimit limit(threads);
  WarningLog log;
  try {
    const AnchoredMesh read = read_ply(path, log, {.pieces = {piece_bytes, {}}});
    return dump(read.mesh, log) + fmt::format(" {}", read.anchor.x);
  } catch (const InputError& e) {
    return e.what();
  }
}

using Import = Scene (*)(const std::string& path, const PieceReading& how);

std::string scene_outcome(Import import, const std::string& path, size_t piece_bytes, int threads) {
  const ThreadLimit limit(threads);
  try {
    const Scene scene = import(path, {piece_bytes, {}});
    std::string out = dump({}, scene.warnings);
    for (const Mesh& m : scene.meshes)
      out += "\n" + m.name + " " + scene.materials[m.material].name + dump(m, {});
    return out + fmt::format("\n{} materials, {} lights, {} textures", scene.materials.size(),
                             scene.lights.size(), scene.textures.size());
  } catch (const InputError& e) {
    return e.what();
  }
}

Scene import_obj_in_pieces(const std::string& path, const PieceReading& how) {
  return import_obj(path, how);
}

// Returns the outcome of reading in one piece. Requires the same of pieces of any size on any
// number of threads.
std::string piecewise_outcome(Import import, const std::string& path) {
  std::string expected = scene_outcome(import, path, 0, 1);
  for (const size_t bytes : {size_t(1), size_t(90), size_t(1) << 20})
    for (const int threads : {1, 3})
      REQUIRE(scene_outcome(import, path, bytes, threads) == expected);
  return expected;
}

// Returns a file with objects, groups and materials, polygons, both kinds of indices, and vertex
// colours in between. It also has indices of later vertices, joined lines, and statements that are
// left out.
std::string obj_text(int n) {
  std::string out = "# strips\nmtllib looks.mtl\ncurv2 1 2\ncurv2 3 4\n";
  for (int i = 0; i < n; ++i) {
    const int first = 4 * i + 1;
    if (i % 4 == 0) out += fmt::format("o object {}\r\ng left\n", i);
    if (i % 3 == 0) out += i % 2 == 0 ? "usemtl shining\n" : "usemtl missing\n";
    for (int k = 0; k < 4; ++k)
      out += fmt::format("v {} {} {:.3f}{}\n", i + k % 2, k / 2, .1 * i,
                         i > n / 2 && k > 1 ? " .5 .25 1" : "");
    if (i == 3) out += "f 1/1 2/1 3/1\nl 1 2\n";
    if (i > n / 3) out += fmt::format("vt {} 1\nvn 0 {} 1\n", i, i % 2);
    if (i % 5 == 1)
      out += fmt::format("f {} {} \\\n {} {}\n", first, first + 1, first + 3, first + 2);
    else if (i > n / 3)
      out += fmt::format("f -4/-1/-1 {}/-1 -1//-1\nf {} {} {}\n", first + 1, first, first + 2, -1);
    else
      out += fmt::format("f {} {} {}\nf -4 -3\n", first, first + 1, first + 3);
  }
  return out + "s off\nf 1 2 3";
}

constexpr const char* looks_text = "newmtl shining\nKd .5 .5 .5\nKe 1 2 3\n";

// Returns a strip of quads and triangles, with a face of two vertices and unknown properties.
std::string ply_text(int n, bool has_faces_first) {
  const std::string vertex = fmt::format(
      "element vertex {}\nproperty float x\nproperty float y\nproperty double z\n"
      "property float u\nproperty float v\n",
      2 * n);
  const std::string face = fmt::format(
      "element face {}\nproperty uchar tag\nproperty list uchar int vertex_indices\n", n);
  std::string vertices, faces;
  for (int i = 0; i < 2 * n; ++i)
    vertices += fmt::format("{} {} {:.3f} {} 1e-3\n", i / 2 + 700, i % 2, .1 * i, .25 * i);
  for (int i = 0; i + 1 < n; ++i)
    faces += i % 3 == 0 ? fmt::format("0 4 {} {} {} {}\n", 2 * i, 2 * i + 2, 2 * i + 3, 2 * i + 1)
                        : fmt::format("7 3 {} {} {}\n", 2 * i, 2 * i + 2, 2 * i + 3);
  faces += "1 2 0 1\n";
  return "ply\nformat ascii 1.0\n" + (has_faces_first ? face + vertex : vertex + face) +
         "element extra 2\nproperty int a\nend_header\n" +
         (has_faces_first ? faces + vertices : vertices + faces) + "5\n6";
}

template <class T>
void put(std::string& out, T value, bool is_big) {
  std::string bytes(sizeof value, '\0');
  std::memcpy(bytes.data(), &value, sizeof value);
  if (is_big) bytes = std::string(bytes.rbegin(), bytes.rend());
  out += bytes;
}

std::string ply_binary(int n, bool is_big) {
  std::string out = fmt::format(
      "ply\nformat binary_{}_endian 1.0\nelement vertex {}\nproperty float x\nproperty short y\n"
      "property double z\nelement face {}\nproperty list uchar uint vertex_indices\n"
      "property list ushort uchar more\nend_header\n",
      is_big ? "big" : "little", n, n - 2);
  for (int i = 0; i < n; ++i) {
    put(out, float(i), is_big);
    put(out, int16_t(i * i), is_big);
    put(out, .3 * i, is_big);
  }
  for (int i = 0; i + 2 < n; ++i) {
    put(out, uint8_t(3), is_big);
    for (int k = 0; k < 3; ++k) put(out, uint32_t(i + k), is_big);
    put(out, uint16_t(i % 4), is_big);
    out.append(size_t(i % 4), 'x');
  }
  return out;
}

std::string stl_text(int n) {
  std::string out = "solid of facets\n";
  for (int i = 0; i < n; ++i)
    out += fmt::format(
        "  facet normal 0 0 1\r\n outer loop\n vertex {0} 0 0\n vertex {1} -0 0\n"
        " vertex {1} 1 {2}\n endloop\n\nendfacet\n",
        i, i + 1, i % 5 == 0 ? "nan" : "2");
  return out + "endsolid\n";
}

}  // namespace

TEST_CASE("PLY in pieces: result, warnings and errors equal those of one piece") {
  const TempFolder folder;
  std::mt19937 random(3);
  size_t errors = 0;
  for (const std::string& whole :
       {ply_text(30, false), ply_text(30, true), ply_binary(40, false), ply_binary(40, true)}) {
    const size_t body = whole.find("end_header");
    for (int round = 0; round < 60; ++round) {
      const std::string text =
          round == 0 ? whole : whole.substr(0, body) + test::mutated(whole.substr(body), random);
      const std::string path = folder.write("m.ply", text);
      const std::string expected = ply_outcome(path, 0, 1);
      errors += expected.find("m.ply:") != std::string::npos ? 1 : 0;
      for (const size_t bytes : {size_t(1), size_t(53), size_t(1) << 20})
        for (const int threads : {1, 3}) {
          CAPTURE(text);
          REQUIRE(ply_outcome(path, bytes, threads) == expected);
        }
    }
  }
  CHECK(errors > 40);
  CHECK(errors < 238);
}

TEST_CASE("STL text in pieces: result, warnings and errors equal those of one piece") {
  const TempFolder folder;
  std::mt19937 random(4);
  const std::string whole = stl_text(25);
  size_t errors = 0;
  for (int round = 0; round < 80; ++round) {
    const std::string text = round == 0 ? whole : test::mutated(whole, random);
    CAPTURE(text);
    const std::string outcome = piecewise_outcome(import_stl, folder.write("m.stl", text));
    errors += outcome.find("m.stl:") != std::string::npos ? 1 : 0;
  }
  CHECK(errors > 8);
  CHECK(errors < 79);
}

TEST_CASE("OBJ in pieces: result, warnings and errors equal those of one piece") {
  const TempFolder folder;
  folder.write("looks.mtl", looks_text);
  std::mt19937 random(6);
  const std::string whole = obj_text(24);
  size_t errors = 0;
  for (int round = 0; round < 80; ++round) {
    const std::string text = round == 0 ? whole : test::mutated(whole, random);
    CAPTURE(text);
    const std::string outcome =
        piecewise_outcome(import_obj_in_pieces, folder.write("m.obj", text));
    errors += outcome.find("m.obj:") != std::string::npos ? 1 : 0;
    if (round > 0) continue;
    CHECK(outcome.find("'curv2' is not supported: left out 2") != std::string::npos);
    CHECK(outcome.find("fewer than three vertices") != std::string::npos);
    CHECK(outcome.find("but there are none 3") != std::string::npos);
    CHECK(outcome.find("left shining") != std::string::npos);
  }
  CHECK(errors > 8);
  CHECK(errors < 72);
}

// The first wrong line is reported, whatever the error and wherever pieces begin.
TEST_CASE("OBJ in pieces: the first error is reported with its line") {
  const TempFolder folder;
  folder.write("looks.mtl", looks_text);
  folder.write("broken.mtl", "newmtl a\nKd inf 0 0\n");
  const std::string whole = obj_text(24);
  const auto refused = [&](const std::string& more) {
    const std::string text = whole + "\n" + more;
    return piecewise_outcome(import_obj_in_pieces, folder.write("m.obj", text));
  };
  const auto lines = std::count(whole.begin(), whole.end(), '\n') + 1;
  const auto at = [&](int line, int column) {
    return fmt::format("m.obj:{}:{}: ", lines + line, column);
  };
  const auto has = [](const std::string& text, const std::string& part) {
    CAPTURE(text);
    CHECK(text.find(part) != std::string::npos);
  };
  has(refused("v 1 2 3\nv 1 x 3\nf 1 2 999\n"), at(2, 5) + "'x' is not a number");
  has(refused("\nf 1 2 999\nv 1 x 3\n"),
      at(2, 7) + "index 999 of a vertex is out of range (96 so far)");
  has(refused("v 1 2 3\nf 1 2 98\nv 1 2 3\n"),
      at(2, 7) + "index 98 of a vertex is out of range (97");
  has(refused("f -96 -1 -97\n"), at(1, 10) + "index -97 of a vertex");
  has(refused("f 1/-2147483648 2 3\n"), at(1, 3) + "index -2147483648 of a texture coordinate");
  has(refused("mtllib broken.mtl\nv 1 x 3\n"), "broken.mtl:2:");
  has(refused("f 1 2\\\n 0\nmtllib broken.mtl\n"), at(1, 8) + "index 0 of a vertex");
}

TEST_CASE("progress of reading increases to the end, reported by one thread at a time") {
  const TempFolder folder;
  folder.write("looks.mtl", looks_text);
  std::vector<double> told;
  const PieceReading how{64, [&](double fraction) { told.push_back(fraction); }};
  const auto check = [&] {
    REQUIRE(told.size() > 10);
    CHECK(std::is_sorted(told.begin(), told.end()));
    CHECK(told.front() >= 0);
    CHECK(told.back() == doctest::Approx(1).epsilon(.1));
    CHECK(told.back() <= 1);
    told.clear();
  };
  for (const int threads : {1, 3}) {
    const ThreadLimit limit(threads);
    import_obj(folder.write("m.obj", obj_text(100)), how);
    check();
    import_stl(folder.write("m.stl", stl_text(100)), how);
    check();
    WarningLog log;
    read_ply(folder.write("m.ply", ply_text(100, false)), log, {1000, how});
    check();
  }
}

TEST_CASE("welded corners are numbered in order of first appearance") {
  std::mt19937 random(5);
  std::vector<Vec3> corners;
  for (size_t i = 0; i < 600'000; ++i) {  // more than one piece
    const auto pick = [&] { return float(int(random() % 40) - 20) * 0.5f; };
    corners.push_back({pick() * -0.0f + pick(), pick(), pick()});
    if (random() % 1000 == 0) corners.back().y = std::numeric_limits<float>::quiet_NaN();
  }
  const Mesh mesh = weld(corners);
  std::map<std::tuple<float, float, float>, uint32_t> known;
  std::vector<Vec3> positions;
  REQUIRE(mesh.triangles.size() == corners.size() / 3);
  for (size_t i = 0; i < corners.size(); ++i) {
    const Vec3& p = corners[i];
    const auto next = uint32_t(positions.size());
    const uint32_t expected =
        is_finite(p) ? known.try_emplace({p.x, p.y, p.z}, next).first->second : next;
    if (expected == next) positions.push_back(p);
    REQUIRE(mesh.triangles[i / 3][i % 3] == expected);
  }
  REQUIRE(mesh.positions.size() == positions.size());
  for (size_t i = 0; i < positions.size(); ++i)
    REQUIRE(bits_of(mesh.positions[i].y) == bits_of(positions[i].y));
}

}  // namespace test_pieces
