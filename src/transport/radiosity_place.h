// A place on the radiosity mesh.
#pragma once

#include <cstdint>

#include "base/vec.h"
#include "radiosity/patch.h"

namespace troffer {

struct RadiosityPlace {
  uint32_t fragment = no_fragment;
  uint32_t point = no_point;  // no_point: off the mesh, nothing is known here
  bool is_back = false;       // of the fragment
  Vec3 weights;
};

}  // namespace troffer
