// Meshes laid out flat: charts, which are groups of triangles that are laid into a plane together,
// without folds and without overlap.
//
// A chart grows from its largest triangle over edges that two triangles share, as long as they face
// much the same way, and is seen straight along that triangle's normal. So a flat part keeps its
// shape, and a curved one shrinks by at most cos(largest_angle). Triangles that would come to lie
// over others become charts of their own.
//
// References: [1] Lévy et al., "Least Squares Conformal Maps for Automatic Texture Atlas
// Generation",
//   SIGGRAPH 2002 (charts, and checking them for overlap). [2] Freeman & Shapira, "Determining the
//   Minimum-Area Encasing Rectangle for an Arbitrary Closed Curve", CACM 18(7), 1975.
#pragma once

#include <cstdint>
#include <vector>

#include "scene/scene.h"

namespace troffer {

struct Chart {
  std::vector<uint32_t> triangles;
  Vec2 size;              // of its rectangle, in the mesh's metres; the longer side lies along x
  float fineness = 1;     // texels per metre, as a share of what others get
  bool is_layer = false;  // of two in one place, one for each side
};

// A mesh of the same triangles, in the same order, with vertices that no two charts share.
struct ChartedMesh {
  Mesh mesh;
  std::vector<Vec2> places;  // per vertex: metres from the corner of its chart's rectangle
  std::vector<Chart> charts;
  // Triangles in none: without area, or not finite. Their vertices are at (0,0).
  size_t degenerate = 0;
};

ChartedMesh charted(const Mesh& mesh);

// The whole of a set of texture coordinates of the mesh as one chart, where it can hold a lightmap:
// all of it in [0,1], triangles neither without area there nor one over the other. False where it
// cannot. The chart is as large as gives the mesh as much area as it has. Only finite triangles
// with area count.
bool chart_of_uvs(const Mesh& mesh, const std::vector<Vec2>& uvs, ChartedMesh& out);

}  // namespace troffer
