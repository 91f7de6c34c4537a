// Which sides of surfaces get light, found by asking for a little of it.
#pragma once

#include <vector>

#include "bake/site_light.h"
#include "bake/surfaces.h"

namespace troffer {

// For every chart of surfaces that are seen from both sides, per BakedSurfaces::charted; empty for
// the others. A chart of a mesh that stands in several places has the sides that it needs in any of
// them. A side that is dark counts where it looks into a room (at fronts of surfaces): nothing of
// the other side's light may show there. Empty once stopped.
std::vector<std::vector<LitSides>> lit_sides(const PreparedScene& scene,
                                             const Integrator& integrator,
                                             const BakedSurfaces& surfaces,
                                             const SiteSettings& settings, const StopFlag& stop);

}  // namespace troffer
