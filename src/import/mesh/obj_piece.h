// Statements of consecutive lines of an OBJ file. A piece is parsed without knowing what comes
// before it, so that pieces can be read in parallel. place_obj_faces resolves the indices once all
// counts are known.
#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "base/rgb.h"
#include "import/recentre.h"

namespace troffer {

// Numbers of items in a file up to some position.
struct ObjCounts {
  size_t positions = 0, uvs = 0, normals = 0, triangles = 0;
  int lines = 0;
  void add(const ObjCounts& more);
};

// Indices of a corner as written: from 1, or negative, counted backwards from the last item so far.
struct ObjWrittenCorner {
  static constexpr int not_given = std::numeric_limits<int>::min();
  int position = not_given, uv = not_given, normal = not_given;
};

// Index that stands for no item.
constexpr uint32_t obj_nothing = 0xffffffffu;
// Resolved indices of a corner, from 0.
struct ObjCorner {
  uint32_t position = obj_nothing, uv = obj_nothing, normal = obj_nothing;
};

// A statement that affects the faces after it.
struct ObjEvent {
  enum class Kind : uint8_t { object, group, material, library, unsupported, colors_begin };
  Kind kind = Kind::unsupported;
  std::string text;
  size_t face = 0, triangle = 0;  // index of the next face and triangle in the piece
  size_t count = 1;               // number of equal statements in a row
};

// Parsed statements of a piece. Reused for further pieces, to keep its memory.
struct ObjPiece {
  std::vector<Vec3d> positions;  // as in the file
  std::vector<Vec3> normals;
  std::vector<Vec2> uvs;
  std::vector<Rgb> colors;  // colors of the first positions; further ones are white
  std::vector<ObjEvent> events;
  size_t points_and_lines = 0;

  std::vector<ObjWrittenCorner> written;  // corners of all faces
  std::vector<uint32_t> sizes;            // numbers of corners of faces
  // Counts in the piece before a face. There is an entry for each face whose counts differ from
  // those before the previous face.
  struct Seen {
    size_t face = 0;
    ObjCounts counts;
  };
  std::vector<Seen> seen;
  ObjCounts counts;  // counts of the whole piece

  // Output of place_obj_faces.
  std::vector<ObjCorner> corners;  // three per triangle
  PlacedBounds bounds;
  size_t short_faces = 0, dangling = 0;

  void clear();  // keeps the memory allocated
};

// Sets `index` to the position, from 0, of a written index among `count` items. Returns false if it
// is out of range.
bool resolve_obj_index(int written, size_t count, uint32_t& index);

// Triangulates the faces of a piece that follows `before`. `positions` holds all positions of the
// file up to the end of the piece, relative to Scene::origin. Returns false if an index is out of
// range or there are too many triangles.
bool place_obj_faces(const ObjCounts& before, const std::vector<Vec3d>& positions, ObjPiece& piece);

}  // namespace troffer
