#include "import/stl.h"

#include <cstring>
#include <map>
#include <tuple>

#include "base/error.h"
#include "import/file.h"
#include "import/limits.h"
#include "import/mesh_clean.h"
#include "import/recentre.h"
#include "import/text_lines.h"

namespace troffer {

namespace {

constexpr size_t header_size = 84, facet_size = 50;  // of binary files

// The corners of all triangles, one after the other.
std::vector<Vec3d> read_binary(const std::string& text, uint64_t count) {
  std::vector<Vec3d> corners;
  corners.reserve(size_t(3 * count));
  for (uint64_t i = 0; i < count; ++i) {
    std::array<float, 9> p{};  // after the normal
    std::memcpy(p.data(), text.data() + header_size + i * facet_size + 12, sizeof p);
    for (size_t k = 0; k < 9; k += 3)
      corners.emplace_back(double(p[k]), double(p[k + 1]), double(p[k + 2]));
  }
  return corners;
}

std::vector<Vec3d> read_text(const std::string& path, const std::string& text) {
  TextLines lines(path, text);
  std::vector<Vec3d> corners;
  size_t in_facet = 0;
  while (lines.next_line()) {
    const std::string_view word = lines.word();
    if (word == "vertex") {
      const double x = lines.precise_number(), y = lines.precise_number();
      corners.emplace_back(x, y, lines.precise_number());
      if (++in_facet > 3) lines.fail("a facet has three vertices");
      if (corners.size() > 3 * max_scene_triangles) lines.fail("too many triangles");
    } else if (word == "endfacet") {
      if (in_facet != 3) lines.fail("a facet has three vertices");
      in_facet = 0;
    } else if (!word.empty() && word != "solid" && word != "facet" && word != "outer" &&
               word != "endloop" && word != "endsolid") {
      lines.fail("'" + std::string(word.substr(0, 40)) + "' is no word of an STL file");
    }
  }
  if (in_facet != 0) lines.fail("the file ends within a facet");
  return corners;
}

uint64_t count_of(const std::string& text) {
  uint32_t count = 0;
  if (text.size() >= header_size) std::memcpy(&count, text.data() + header_size - 4, sizeof count);
  return count;
}

// Binary files may begin with "solid" too: their length tells them.
std::vector<Vec3d> read_corners(const std::string& path, const std::string& text) {
  const uint64_t count = count_of(text);
  const bool fits = text.size() >= header_size && count <= (text.size() - header_size) / facet_size;
  const bool is_exact = fits && text.size() == header_size + count * facet_size;
  if (!is_exact && text.find("solid") == text.find_first_not_of(" \t\r\n"))
    return read_text(path, text);
  if (!fits)
    throw InputError(
        path, 0, 0,
        "is no STL file, or is too short for its " + std::to_string(count) + " triangles");
  if (count > max_scene_triangles) throw InputError(path, 0, 0, "has too many triangles");
  return read_binary(text, count);
}

Mesh mesh_of(const std::vector<Vec3d>& corners, const Vec3d& origin, PlacedBounds& bounds) {
  Mesh mesh;
  std::map<std::tuple<float, float, float>, uint32_t> known;
  for (size_t i = 0; i + 2 < corners.size(); i += 3) {
    Triangle t;
    for (size_t k = 0; k < 3; ++k) {
      const Vec3 p(corners[i + k] - origin);
      const auto [at, is_new] =
          is_finite(p) ? known.try_emplace({p.x, p.y, p.z}, uint32_t(mesh.positions.size()))
                       : std::pair{known.end(), true};
      t[k] = is_new ? uint32_t(mesh.positions.size()) : at->second;
      if (is_new) mesh.positions.push_back(p);
    }
    bounds.add_triangle(corners[i] - origin, corners[i + 1] - origin, corners[i + 2] - origin);
    mesh.triangles.push_back(t);
  }
  return mesh;
}

}  // namespace

Scene import_stl(const std::string& path) {
  return import_recentred([&](Scene& scene, PlacedBounds& bounds) {
    scene.file = path;
    const std::string text = read_text_file(path);
    Mesh mesh = mesh_of(read_corners(path, text), scene.origin, bounds);
    show_alone(std::move(mesh), scene);
  });
}

}  // namespace troffer
