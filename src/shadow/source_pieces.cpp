#include "shadow/source_pieces.h"

#include <algorithm>
#include <span>
#include <utility>

#include "base/merge_polygons.h"
#include "light/polygon.h"

namespace troffer {

namespace {

bool add_piece(std::span<const Vec3> outline, uint32_t primitive, std::vector<SourcePiece>& out) {
  SourcePiece piece;
  if (!make_flat_source(outline, piece.shape)) return false;
  piece.primitives.push_back(primitive);
  out.push_back(std::move(piece));
  return true;
}

// Adds a polygon with many corners as parts of a fan around its first corner.
bool add_parts(std::span<const Vec3> outline, uint32_t primitive, std::vector<SourcePiece>& out) {
  std::vector<Vec3> part;
  for (size_t first = 1; first + 1 < outline.size(); first += most_outline_corners - 2) {
    const size_t last = std::min(first + most_outline_corners - 2, outline.size() - 1);
    part.assign(1, outline[0]);
    part.insert(part.end(), outline.begin() + std::ptrdiff_t(first),
                outline.begin() + std::ptrdiff_t(last) + 1);
    if (!add_piece(part, primitive, out)) return false;
  }
  return true;
}

// Polygons that may be merged.
struct Polygons {
  std::vector<Vec3> positions;
  std::vector<uint32_t> corners;  // corners of the polygon that is being added
  PolygonList list;
  std::vector<uint32_t> primitives;

  void add(std::span<const Vec3> outline, uint32_t primitive) {
    corners.clear();
    for (const Vec3& v : outline) {
      corners.push_back(uint32_t(positions.size()));
      positions.push_back(v);
    }
    list.add(corners);
    primitives.push_back(primitive);
  }
};

bool add_merged(Polygons& polygons, std::vector<SourcePiece>& out) {
  const std::vector<uint32_t> welded = weld(polygons.positions);
  for (uint32_t& c : polygons.list.corners) c = welded[c];
  const auto edges = sorted_edges(polygons.list, polygons.positions.size());
  const MergedPolygons merged =
      merge_polygons(polygons.positions, polygons.list, edges, most_outline_corners);
  const size_t first = out.size();
  std::vector<Vec3> outline;
  for (size_t i = 0; i < merged.polygons.size(); ++i) {
    outline.clear();
    for (const uint32_t c : merged.polygons[i]) outline.push_back(polygons.positions[c]);
    SourcePiece piece;
    if (!make_flat_source(outline, piece.shape)) return false;
    out.push_back(std::move(piece));
  }
  for (size_t i = 0; i < merged.of_piece.size(); ++i)
    if (merged.of_piece[i] != no_polygon)
      out[first + merged.of_piece[i]].primitives.push_back(polygons.primitives[i]);
  return true;
}

}  // namespace

bool merge_sources(const LightPrimitives& primitives, uint32_t light,
                   std::vector<SourcePiece>& out) {
  out.clear();
  const LightPrimitives::Range range = primitives.of_light(light);
  Polygons polygons;
  bool is_good = true;
  for (uint32_t p = range.first; p < range.last && is_good; ++p) {
    const LightPrimitive& piece = primitives[p];
    if (piece.is_textured) {
      is_good = false;
    } else if (piece.vertex_count == 0) {
      SourcePiece whole;
      whole.primitives.push_back(p);
      is_good = make_flat_source(piece, false, whole.shape);
      out.push_back(std::move(whole));
    } else if (piece.vertex_count > most_outline_corners) {
      is_good = add_parts({&piece.vertex(0), piece.vertex_count}, p, out);
    } else {
      polygons.add({&piece.vertex(0), piece.vertex_count}, p);
    }
  }
  is_good = is_good && add_merged(polygons, out);
  if (!is_good) out.clear();
  return is_good;
}

}  // namespace troffer
