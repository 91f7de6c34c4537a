// Unwraps meshes into charts: groups of triangles that lie flat in a plane without folds or
// overlaps. The atlas places charts on pages.
//
// A chart grows from its largest triangle across edges that exactly two triangles share, as long as
// they face nearly the same way. It is projected along the normal of the first triangle. Flat parts
// keep their shape, and curved parts shrink by at most cos(largest angle). Triangles that would
// overlap others start charts of their own.
//
// References: [1] Lévy et al., "Least Squares Conformal Maps for Automatic Texture Atlas
// Generation", SIGGRAPH 2002 (charts, and checking them for overlap). [2] Freeman & Shapira,
// "Determining the Minimum-Area Encasing Rectangle for an Arbitrary Closed Curve", CACM 18(7),
// 1975.
#pragma once

#include <cstdint>
#include <vector>

#include "scene/scene.h"

namespace troffer {

// A group of triangles in a rectangle.
struct Chart {
  std::vector<uint32_t> triangles;
  Vec2 size;           // size of its rectangle, in metres of the mesh; the longer side is along x
  float fineness = 1;  // texels per metre, relative to other charts
  bool is_layer = false;  // one of two charts in one place, one for each side
};

// A mesh with the same triangles in the same order, whose charts share no vertices.
struct ChartedMesh {
  Mesh mesh;
  std::vector<Vec2> places;  // per vertex: position in its chart's rectangle, m
  std::vector<Chart> charts;
  // Number of triangles in no chart: without area, or not finite. Their vertices have place (0,0).
  size_t degenerate = 0;
};

// Divides a mesh into charts.
ChartedMesh charted(const Mesh& mesh);

// Makes one chart of a set of texture coordinates, if it can hold a lightmap: all coordinates in
// [0,1], no triangle without area there, no overlaps. Returns false otherwise. The chart's scale
// preserves the total area of the mesh. Only finite triangles with area are considered.
bool chart_of_uvs(const Mesh& mesh, const std::vector<Vec2>& uvs, ChartedMesh& out);

}  // namespace troffer
