// Patches and elements: what shoots and what receives in the radiosity preprocessing.
#pragma once

#include <cstdint>

#include "base/rgb.h"
#include "base/vec.h"

namespace troffer {

// A sample point: where radiosity is received and stored. It stands for an element of a patch.
struct ElementPoint {
  Vec3 position;
  Vec3 normal;          // unit, on the side that receives
  float area = 0;       // m² of the element
  Rgb reflectance;      // of the element, hemispherical
  uint32_t patch = 0;
};

}  // namespace troffer
