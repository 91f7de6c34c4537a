// Finds which sides of two-sided surfaces get light, by a few samples of each chart. bake() uses
// it.
#pragma once

#include <vector>

#include "bake/site_light.h"
#include "bake/surfaces.h"

namespace troffer {

// Returns the lit sides of every chart of two-sided surfaces, by BakedSurfaces::charted; empty for
// other surfaces. A chart of a mesh with several instances gets the sides that it needs in any of
// them. A dark side counts if it faces a room (rays from it hit fronts of surfaces), because light
// of the other side must not show there. Returns an empty list if stopped.
std::vector<std::vector<LitSides>> lit_sides(const PreparedScene& scene,
                                             const Integrator& integrator,
                                             const BakedSurfaces& surfaces,
                                             const SiteSettings& settings, const StopFlag& stop);

}  // namespace troffer
