// Surfaces that emit in other units than the lamps beside them.
//
// Blender's exporter writes the strength of emission, W/(m² sr), as cd/m² without a factor, and the
// power of lamps, W, with 683 lm/W (docs/from-blender.md): a panel is 683 times too dark then.
#pragma once

#include "scene/scene.h"

namespace troffer {

// Multiplies the emission of surfaces by `factor`. Measured luminaires stay as they are. UsageError
// where it is no number of at least 0.
void scale_surface_emission(Scene& scene, double factor);

// Warns of a photometric scene in which surfaces emit as hardly any luminaire does, under 100 cd/m²
// from more than .05 m², and less than a hundredth of what points and spots send.
void warn_of_weak_surfaces(Scene& scene);

}  // namespace troffer
