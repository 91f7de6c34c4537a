// A place on the radiosity mesh: the fragment and point of a hit, and the interpolation weights
// there. The kj92 method finds it once per hit (RadiosityLight::places) and keeps it in
// WaveHits::places.
#pragma once

#include <cstdint>

#include "base/vec.h"
#include "radiosity/patch.h"

namespace troffer {

struct RadiosityPlace {
  uint32_t fragment = no_fragment;
  uint32_t point = no_point;  // no_point: off the mesh, radiosity is unknown here
  bool is_back = false;       // on the fragment's back
  Vec3 weights;
};

}  // namespace troffer
