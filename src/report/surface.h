// Flat surfaces whose light is assessed, and the points where it is measured.
// find_surfaces() and the measuring grids of `view` make them. Lengths are in metres.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "base/vec.h"
#include "report/grid.h"

namespace troffer {

enum class SurfaceKind : uint8_t { desk, floor, work_plane, given };
const char* name_of(SurfaceKind kind);

using PlaneTriangle = std::array<Vec2d, 3>;

// A flat surface. Positions are in the file's coordinates, m; plane coordinates are metres from
// `corner` along `along` and `across`.
struct AssessedSurface {
  std::string name;
  std::string profile;  // profile id
  SurfaceKind kind = SurfaceKind::given;
  Vec3d corner;                                 // corner of the bounding rectangle
  Vec3d along{1, 0, 0}, across{0, 1, 0};        // unit, orthogonal; across = normal × along
  double width = 0, height = 0;                 // size of the bounding rectangle, m
  std::vector<PlaneTriangle> triangles;         // empty: the rectangle is full
  std::vector<std::array<Vec2d, 2>> rim;        // border edges; empty: the rectangle's
  double area = 0;                              // m²
  double border = 0;                            // width of the zone along the rim without points, m
  double spacing = 0;                           // largest side of a cell, m; 0: by grid_shape()
  double height_of_eye = 1.2, above_floor = 0;  // m; height of the surface above its floor

  Vec3d normal() const { return cross(along, across); }
  Vec3d place(const Vec2d& p) const { return corner + along * p.x + across * p.y; }
};

// A measuring point of a grid.
struct GridPoint {
  int column = 0, row = 0;
  Vec3d position;  // in the file's coordinates
};

// Cells of the bounding rectangle without its border. A cell yields a point if its middle lies on
// the surface and off the rim. If no cell does, the surface's middle is the only point.
struct SurfaceGrid {
  GridShape shape;
  Vec2d first, cell;  // corner of cell (0,0), and a cell's sides, in the plane, m
  std::vector<GridPoint> points;
};

SurfaceGrid grid_of(const AssessedSurface& surface);

// True if a place in the plane is part of the surface.
bool lies_on(const AssessedSurface& surface, const Vec2d& place);

// Returns the middle of the bounding rectangle, or of the largest triangle if the former lies off
// the surface. In the file's coordinates.
Vec3d middle_of(const AssessedSurface& surface);

// Builds a surface from triangles in a plane with the unit normal n; name, kind and profile stay
// unset. The rim is `known_rim` if given. Otherwise it follows from the triangles, which must then
// share corners.
AssessedSurface surface_of_triangles(const std::vector<std::array<Vec3d, 3>>& triangles,
                                     const Vec3d& n,
                                     const std::vector<std::array<Vec3d, 2>>& known_rim = {});

}  // namespace troffer
