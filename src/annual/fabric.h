// Fabrics of blinds, by the figures that EN 14501 data sheets give. Light that passes the holes
// goes straight on and keeps its edges; threads scatter the rest evenly to both sides.
//
// References: [1] EN 14501:2021, "Blinds and shutters. Thermal and visual comfort. Performance
//   characteristics and classification".
//   [2] EN 14500:2021, "Blinds and shutters. Thermal and visual comfort. Test methods".
#pragma once

#include <string>

#include "scene/material.h"

namespace troffer {

// Values for light that arrives along the normal, 0 to 1 [1, 2].
struct Fabric {
  std::string name;
  double openness = 0;       // normal/normal transmittance, or the share of holes
  double transmittance = 0;  // normal/hemispherical, of visible light; includes the openness
  double reflectance = 0;    // normal/hemispherical, of visible light, on both sides
};

// Returns what is wrong with the values, or an empty text.
std::string fault_of(const Fabric& fabric);

// Returns a surface that covers all but the holes, and reflects and transmits by Lambert's law. The
// straight share is the same at all angles. Precondition: fault_of() is empty.
Material material_of(const Fabric& fabric);

}  // namespace troffer
