// Elements of a cut mesh: their fragments, areas and centroids. make_points() uses them to place
// sample points. Areas are in m², positions in world space.
#pragma once

#include <cstdint>
#include <vector>

#include "radiosity/meshing.h"

namespace troffer {

struct ElementInfo {
  double area = 0;
  Vec3d centroid;
  uint32_t first = 0, last = 0;  // range in `order`
  uint32_t fragment = 0;         // fragment with the sample point
};

struct Elements {
  std::vector<ElementInfo> infos;
  std::vector<uint32_t> order;  // fragments, grouped by element
  // per fragment; fragments of round surfaces are scaled to the true area
  std::vector<double> area;
  std::vector<uint32_t> base_triangle;  // per fragment
};
Elements gather_elements(const Scene& scene, const RadiosityMesh& mesh);

// Returns the centroid of a fragment.
Vec3d middle(const RadiosityMesh& mesh, uint32_t fragment);

}  // namespace troffer
