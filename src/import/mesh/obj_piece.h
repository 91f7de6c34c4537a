// The statements of some consecutive lines of an OBJ file, which can be read without those before
// them, so that files are read in pieces side by side.
#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "base/rgb.h"
#include "import/recentre.h"

namespace troffer {

// What there is of a file up to some place.
struct ObjCounts {
  size_t positions = 0, uvs = 0, normals = 0, triangles = 0;
  int lines = 0;
  void add(const ObjCounts& more);
};

// The indices of one corner as written: from 1, or below 0 backwards from the end of what there is.
struct ObjWrittenCorner {
  static constexpr int not_given = std::numeric_limits<int>::min();
  int position = not_given, uv = not_given, normal = not_given;
};

// From 0; obj_nothing where there is none.
constexpr uint32_t obj_nothing = 0xffffffffu;
struct ObjCorner {
  uint32_t position = obj_nothing, uv = obj_nothing, normal = obj_nothing;
};

// A statement that says something about the faces after it.
struct ObjEvent {
  enum class Kind : uint8_t { object, group, material, library, unsupported, colors_begin };
  Kind kind = Kind::unsupported;
  std::string text;
  size_t face = 0, triangle = 0;  // the number of those before it in the piece
  size_t count = 1;               // of the same, one after the other
};

struct ObjPiece {
  std::vector<Vec3d> positions;  // as in the file
  std::vector<Vec3> normals;
  std::vector<Vec2> uvs;
  std::vector<Rgb> colors;  // of the first positions; white of further ones
  std::vector<ObjEvent> events;
  size_t points_and_lines = 0;

  std::vector<ObjWrittenCorner> written;  // of all faces
  std::vector<uint32_t> sizes;            // of faces, in corners
  // What there is in the piece before a face, where that is more than before the one before.
  struct Seen {
    size_t face = 0;
    ObjCounts counts;
  };
  std::vector<Seen> seen;
  ObjCounts counts;  // of the whole piece

  // Made of the faces by place_obj_faces.
  std::vector<ObjCorner> corners;  // three for each triangle
  PlacedBounds bounds;
  size_t short_faces = 0, dangling = 0;

  void clear();  // keeps memory
};

// Where an index leads to among `count` things, from 0; or that it leads nowhere.
bool find_obj_index(int written, size_t count, uint32_t& index);

// Triangles of the faces of a piece that comes after `before`; `positions` are those of the file up
// to the end of the piece, from the scene's origin. False where an index is out of range or there
// are too many triangles.
bool place_obj_faces(const ObjCounts& before, const std::vector<Vec3d>& positions, ObjPiece& piece);

}  // namespace troffer
