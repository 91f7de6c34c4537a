// What a list of occluders holds beside facets that are clear of the source: spheres, disks, and
// facets that may enter a sphere that is the source.
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
  // Of a sphere as source: the sphere, within which nothing hides anything, and the facets that may
  // enter it. Frames are then the disk that its outline spans from the receiver.
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
