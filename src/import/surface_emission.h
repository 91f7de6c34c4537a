// Correction for surfaces whose emission has other units than the lamps beside them.
//
// Blender's exporter writes the strength of emission, W/(m² sr), as cd/m² without a factor, but
// converts the power of lamps, W, by 683 lm/W (docs/guide/from-blender.md). A luminous panel is
// then 683 times too dark.
#pragma once

#include "scene/scene.h"

namespace troffer {

// Multiplies the emission of surfaces by `factor`, except luminaires with a photometric web. Throws
// UsageError unless `factor` is finite and not negative.
void scale_surface_emission(Scene& scene, double factor);

// Warns if a photometric scene has implausibly dim surfaces: below 100 cd/m² on more than 0.05 m²,
// with less than a hundredth of the flux of points and spots.
void warn_of_weak_surfaces(Scene& scene);

}  // namespace troffer
