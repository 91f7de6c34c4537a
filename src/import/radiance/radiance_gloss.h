// Converts Radiance's reflecting and transmitting materials to scene materials. Used by
// RadianceMaterials. Approximations add warnings.
//
// References: [1] "The RADIANCE 5.1 Synthetic Imaging System", §2.1.2 (materials); [2] G. Ward,
//   "Measuring and Modeling Anisotropic Reflection", SIGGRAPH 1992 (rough gloss); [3] G. Ward
//   Larson, R. Shakespeare, "Rendering with Radiance", 1998, ch. 10 (glass).
#pragma once

#include "import/radiance/radiance_pattern.h"
#include "scene/scene.h"

namespace troffer {

// Number of real arguments that a material needs; -1 if the type is not a material.
int least_radiance_reals(const std::string& type);

// Converts a modifier that has that many arguments. Approximations add warnings.
Material radiance_material(const RadianceModifier& m, WarningLog& warnings);

}  // namespace troffer
