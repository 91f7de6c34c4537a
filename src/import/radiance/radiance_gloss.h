// Radiance's materials that reflect and transmit -> materials.
//
// References: [1] "The RADIANCE 5.1 Synthetic Imaging System", §2.1.2 (materials); [2] G. Ward,
//   "Measuring and Modeling Anisotropic Reflection", SIGGRAPH 1992 (rough gloss); [3] G. Ward
//   Larson, R. Shakespeare, "Rendering with Radiance", 1998, ch. 10 (glass).
#pragma once

#include "import/radiance/radiance_pattern.h"
#include "scene/scene.h"

namespace troffer {

// The number of real arguments that a material needs; -1: that type is no material.
int least_radiance_reals(const std::string& type);

// The material of a modifier that has that many; what is approximated goes to the warnings.
Material radiance_material(const RadianceModifier& m, WarningLog& warnings);

}  // namespace troffer
