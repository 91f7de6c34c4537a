// Elements of a cut mesh: the fragments that they are made of, their areas and middles.
#pragma once

#include <cstdint>
#include <vector>

#include "radiosity/meshing.h"

namespace troffer {

struct ElementInfo {
  double area = 0;
  Vec3d centroid;
  uint32_t first = 0, last = 0;  // in `order`
  uint32_t fragment = 0;         // the one that holds the sample point
};

struct Elements {
  std::vector<ElementInfo> infos;
  std::vector<uint32_t> order;          // fragments by element
  std::vector<double> area;             // of fragments; round surfaces' flat ones scaled up
  std::vector<uint32_t> base_triangle;  // of fragments
};
Elements gather_elements(const Scene& scene, const RadiosityMesh& mesh);

// Of a fragment's corners.
Vec3d middle(const RadiosityMesh& mesh, uint32_t fragment);

}  // namespace troffer
