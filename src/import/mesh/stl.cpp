#include "import/mesh/stl.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cstring>
#include <optional>

#include "base/error.h"
#include "base/parallel.h"
#include "import/file.h"
#include "import/limits.h"
#include "import/mesh_clean.h"
#include "import/recentre.h"
#include "import/text_lines.h"
#include "import/weld.h"

namespace troffer {

namespace {

constexpr size_t stl_header_size = 84, stl_facet_size = 50;  // bytes, of binary files
constexpr double stl_corners_progress = 0.6;  // share of the progress for reading corners

// Corners of all triangles in sequence, for both kinds of file.
class StlCorners {
 public:
  // Throws InputError if the file is not STL, is cut short, or has too many triangles.
  StlCorners(const std::string& path, std::string_view text, const PieceReading& how);
  size_t size() const { return is_binary_ ? 3 * count_ : corners_.size(); }
  Vec3d at(size_t i) const {
    if (!is_binary_) return corners_[i];
    std::array<float, 3> p{};  // corner 0 follows the facet's normal
    std::memcpy(p.data(),
                text_.data() + stl_header_size + i / 3 * stl_facet_size + 12 * (1 + i % 3),
                sizeof p);
    return {double(p[0]), double(p[1]), double(p[2])};
  }

 private:
  std::string_view text_;
  bool is_binary_ = false;
  size_t count_ = 0;
  std::vector<Vec3d> corners_;
};

std::vector<Vec3d> read_stl_text(const std::string& path, std::string_view text,
                                 bool is_whole = true) {
  TextLines lines(path, text, is_whole);
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
      lines.fail("'" + std::string(word.substr(0, 40)) + "' is not a keyword of STL");
    }
  }
  if (in_facet != 0) lines.fail("the file ends within a facet");
  return corners;
}

// Reads pieces in parallel. Returns nothing if a piece does not hold whole facets or is malformed.
// The caller then reads from the start, which finds the first error and its position.
std::optional<std::vector<Vec3d>> read_stl_pieces(const std::string& path, std::string_view text,
                                                  const PieceReading& how) {
  const std::vector<std::string_view> pieces = cut_at_lines(text, how.piece_bytes, "facet");
  std::vector<std::vector<Vec3d>> read(pieces.size());
  std::atomic<bool> is_sound{true};
  ReadProgress progress(how.progress, file_progress, stl_corners_progress, pieces.size());
  parallel_for(pieces.size(), 0, [&](size_t i) {
    if (!is_sound) return;
    try {
      read[i] = read_stl_text(path, pieces[i], i == 0);
      progress.add(1);
    } catch (const InputError&) {
      is_sound = false;
    }
  });
  std::vector<size_t> firsts{0};
  for (const auto& corners : read) firsts.push_back(firsts.back() + corners.size());
  if (!is_sound || firsts.back() > 3 * max_scene_triangles) return std::nullopt;
  std::vector<Vec3d> all(firsts.back());
  parallel_for(read.size(), 0, [&](size_t i) {
    std::copy(read[i].begin(), read[i].end(), all.begin() + std::ptrdiff_t(firsts[i]));
    read[i] = {};
  });
  return all;
}

uint64_t count_of(std::string_view text) {
  uint32_t count = 0;
  if (text.size() >= stl_header_size)
    std::memcpy(&count, text.data() + stl_header_size - 4, sizeof count);
  return count;
}

// Binary files may begin with "solid" too, so the length decides.
StlCorners::StlCorners(const std::string& path, std::string_view text, const PieceReading& how)
    : text_(text) {
  const uint64_t count = count_of(text);
  const bool fits =
      text.size() >= stl_header_size && count <= (text.size() - stl_header_size) / stl_facet_size;
  const bool is_exact = fits && text.size() == stl_header_size + count * stl_facet_size;
  if (!is_exact && text.find("solid") == text.find_first_not_of(" \t\r\n")) {
    std::optional<std::vector<Vec3d>> pieces;
    if (how.piece_bytes > 0) pieces = read_stl_pieces(path, text, how);
    corners_ = pieces ? std::move(*pieces) : read_stl_text(path, text);
    return;
  }
  if (!fits)
    throw InputError(
        path, 0, 0,
        "is not an STL file, or is too short for its " + std::to_string(count) + " triangles");
  if (count > max_scene_triangles) throw InputError(path, 0, 0, "has too many triangles");
  is_binary_ = true;
  count_ = size_t(count);
}

Mesh mesh_of(const StlCorners& corners, const Vec3d& origin, const TellProgress& tell,
             PlacedBounds& bounds) {
  std::vector<Vec3> placed(corners.size());
  parallel_pieces(placed.size(), size_t(1) << 16, [&](size_t first, size_t end) {
    for (size_t i = first; i < end; ++i) placed[i] = Vec3(corners.at(i) - origin);
  });
  bounds.add_triangles(corners.size() / 3, [&](size_t t) {
    const auto at = [&](size_t k) { return corners.at(3 * t + k) - origin; };
    return std::array<Vec3d, 3>{at(0), at(1), at(2)};
  });
  return weld(placed, tell, stl_corners_progress);
}

}  // namespace

Scene import_stl(const std::string& path, const PieceReading& how) {
  return import_recentred([&](Scene& scene, PlacedBounds& bounds) {
    scene.file = path;
    const FileBytes bytes(path, default_max_file_bytes, how.progress);
    const StlCorners corners(path, bytes.view(), how);
    add_only_mesh(mesh_of(corners, scene.origin, how.progress, bounds), scene);
  });
}

}  // namespace troffer
