#include "import/mesh/obj_piece.h"

#include "import/limits.h"
#include "import/polygon.h"

namespace troffer {

void ObjCounts::add(const ObjCounts& more) {
  positions += more.positions;
  uvs += more.uvs;
  normals += more.normals;
  triangles += more.triangles;
  lines += more.lines;
}

void ObjPiece::clear() {
  positions.clear();
  normals.clear();
  uvs.clear();
  colors.clear();
  events.clear();
  written.clear();
  sizes.clear();
  seen.clear();
  corners.clear();
  counts = {};
  bounds = {};
  points_and_lines = short_faces = dangling = 0;
}

bool resolve_obj_index(int written, size_t count, uint32_t& index) {
  const int64_t i = written < 0 ? int64_t(count) + written : int64_t(written) - 1;
  index = uint32_t(i);
  return written != 0 && i >= 0 && i < int64_t(count);
}

namespace {

class ObjFacePlacer {
 public:
  ObjFacePlacer(const ObjCounts& before, const std::vector<Vec3d>& positions, ObjPiece& piece)
      : before_(before), positions_(positions), piece_(piece), counts_(before) {}

  bool place() {
    auto seen = piece_.seen.begin();
    auto event = piece_.events.begin();
    const ObjWrittenCorner* at = piece_.written.data();
    piece_.corners.reserve(3 * piece_.counts.triangles);
    for (size_t face = 0; face < piece_.sizes.size(); ++face) {
      for (; event != piece_.events.end() && event->face == face; ++event)
        event->triangle = piece_.corners.size() / 3;
      if (seen != piece_.seen.end() && seen->face == face) {
        counts_ = before_;
        counts_.add(seen++->counts);
      }
      if (!place_face(at, piece_.sizes[face])) return false;
      at += piece_.sizes[face];
    }
    for (; event != piece_.events.end(); ++event) event->triangle = piece_.corners.size() / 3;
    return true;
  }

 private:
  const ObjCounts& before_;
  const std::vector<Vec3d>& positions_;
  ObjPiece& piece_;
  ObjCounts counts_;  // before the face
  std::vector<ObjCorner> face_;
  std::vector<Vec3> points_;
  std::vector<Triangle> triangles_;

  // Resolves an optional index. Some files refer to normals or texture coordinates but hold none;
  // those are counted and ignored.
  bool find_optional(int written, size_t count, uint32_t& index) {
    if (written == ObjWrittenCorner::not_given) return true;
    if (count > 0) return resolve_obj_index(written, count, index);
    ++piece_.dangling;
    return true;
  }

  bool place_face(const ObjWrittenCorner* written, uint32_t size) {
    face_.assign(size, {});
    for (uint32_t i = 0; i < size; ++i)
      if (!resolve_obj_index(written[i].position, counts_.positions, face_[i].position) ||
          !find_optional(written[i].uv, counts_.uvs, face_[i].uv) ||
          !find_optional(written[i].normal, counts_.normals, face_[i].normal))
        return false;
    if (size < 3) {
      ++piece_.short_faces;
      return true;
    }
    if (size == 3) {
      add_triangle({0, 1, 2});
      return true;
    }
    points_.clear();
    triangles_.clear();
    for (const ObjCorner& c : face_) points_.emplace_back(positions_[c.position]);
    triangulate(points_, triangles_);
    for (const Triangle& t : triangles_) add_triangle(t);
    return true;
  }

  // Adds a triangle of three corners of the current face.
  void add_triangle(const Triangle& t) {
    for (const uint32_t k : t) piece_.corners.push_back(face_[k]);
    const auto at = [&](size_t k) { return positions_[face_[t[k]].position]; };
    piece_.bounds.add_triangle(at(0), at(1), at(2));
  }
};

}  // namespace

bool place_obj_faces(const ObjCounts& before, const std::vector<Vec3d>& positions,
                     ObjPiece& piece) {
  if (before.triangles + piece.counts.triangles > max_scene_triangles) return false;
  return ObjFacePlacer(before, positions, piece).place();
}

}  // namespace troffer
