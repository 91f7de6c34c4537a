// Occluders that are not ordinary facets: spheres, disks, and facets that may enter a spherical
// source. FacetList holds one such list; round_cover.h rasterises it.
#pragma once

#include <vector>

#include "base/quad.h"
#include "base/round_body.h"
#include "base/vec.h"

namespace troffer {

struct Ball {
  Vec3d centre;
  double radius = 0;
};

struct RoundList {
  std::vector<RoundBody> bodies;
  // For a spherical source: the sphere, inside which nothing hides anything, and the facets that
  // may enter it. Frames then cover the disk that the sphere's outline spans from the receiver.
  bool is_source_round = false;
  Ball source;
  std::vector<Quad> entering;

  size_t size() const { return bodies.size() + entering.size(); }
  void clear() {
    bodies.clear();
    entering.clear();
    is_source_round = false;
  }
};

}  // namespace troffer
