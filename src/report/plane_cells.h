// The plane cut into cells by line segments: a trapezoidal decomposition. Floors use it to find the
// regions between walls exactly.
//
// The plane is turned by a fixed odd angle first, so that walls along the axes are never parallel
// to the slabs between end points. Segments closer than a tenth of a millimetre count as one.
// Reference: de Berg et al., "Computational Geometry", 3rd ed., ch. 6 (trapezoidal maps).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "base/vec.h"

namespace troffer {

// Meaning of a segment; a bit set, since segments may lie on each other.
enum SegmentKind : uint8_t {
  segment_outline = 1,  // rim of a floor face, the face on its left
  segment_wall = 2,     // cut through what stands in the plane of walls
  segment_body = 4,     // cut through what stands on the floor
};

struct PlaneSegment {
  Vec2d a, b;
  uint8_t kind = segment_outline;
  bool is_solid = false;  // rim of a body's cross-section, the body on its left
};

struct PlaneCell {
  std::array<Vec2d, 4> corners;  // counterclockwise; two may coincide
  Vec2d middle;
  double area = 0;  // m²
  int cover = 0;    // number of floor faces over the cell
  int solid = 0;    // number of bodies' cross-sections over it
};

// A stretch of border between two cells, or between a cell and the outside.
constexpr size_t no_plane_cell = size_t(-1);
struct CellContact {
  size_t left = no_plane_cell,
         right = no_plane_cell;  // cells; the upper and the lower one where no segment is
  uint8_t kinds = 0;             // of the segments between them; 0: none
  size_t segment = 0;            // number of one of them
  Vec2d from, to;
};

struct PlaneCells {
  std::vector<PlaneCell> cells;
  std::vector<CellContact> contacts;
};

// All bounded cells of some width. Memory and time grow with the square of the number of segments
// at worst: the caller bounds it.
PlaneCells cells_between(const std::vector<PlaneSegment>& segments);

}  // namespace troffer
