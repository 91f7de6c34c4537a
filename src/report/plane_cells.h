// Cuts the plane into cells by line segments: a trapezoidal decomposition. The search for rooms
// uses it to find the regions between walls exactly. Lengths are in metres.
//
// The plane is rotated by a fixed odd angle first, so that walls along the axes are never parallel
// to the slabs between end points. Segments closer than a tenth of a millimetre count as one.
// Reference: de Berg et al., "Computational Geometry", 3rd ed., ch. 6 (trapezoidal maps).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "base/vec.h"

namespace troffer {

// Meaning of a segment. Kinds are bits, since segments may coincide.
enum SegmentKind : uint8_t {
  segment_outline = 1,  // outline of a floor face; the face is on its left
  segment_wall = 2,     // cut through objects at the height of walls
  segment_body = 4,     // cut through objects that stand on the floor
};

// An input segment from a to b.
struct PlaneSegment {
  Vec2d a, b;
  uint8_t kind = segment_outline;
  bool is_solid = false;  // outline of a body's cross-section; the body is on its left
};

// A trapezoid of the decomposition.
struct PlaneCell {
  std::array<Vec2d, 4> corners;  // counterclockwise; two may coincide
  Vec2d middle;
  double area = 0;  // m²
  int cover = 0;    // number of floor faces over the cell
  int solid = 0;    // number of bodies' cross-sections over the cell
};

// A stretch of the border between two cells, or between a cell and the outside.
constexpr size_t no_plane_cell = size_t(-1);
struct CellContact {
  size_t left = no_plane_cell,
         right = no_plane_cell;  // cells; without a segment: the lower and the upper one
  uint8_t kinds = 0;             // kinds of the segments between them; 0: no segment
  size_t segment = 0;            // index of one of these segments
  Vec2d from, to;
};

// Result of cells_between().
struct PlaneCells {
  std::vector<PlaneCell> cells;
  std::vector<CellContact> contacts;
};

// Returns all bounded cells of non-zero width, and their contacts. Time and memory grow at worst
// with the square of the number of segments, which the caller must limit.
PlaneCells cells_between(const std::vector<PlaneSegment>& segments);

}  // namespace troffer
