// Converts Radiance's distant sources to suns, skies and environment lights. Used by
// RadianceSurfaces.
#pragma once

#include <string>

#include "import/radiance/radiance_material.h"

namespace troffer {

// Appends the light of a `source` in the direction `to` (unit) that is `angle_deg` wide. `pattern`
// may be null. Without pattern, a hemisphere becomes a sky, and the whole sphere a uniform
// environment. Up to 60 degrees a source becomes a sun. All others become an image of their cone
// with 1024 × 512 texels. Returns false if the source cannot be used. Throws InputError if its
// pattern cannot be evaluated.
bool add_radiance_source(const RadianceLook& look, RadiancePattern* pattern, const Vec3d& to,
                         double angle_deg, const std::string& name, Scene& scene);

}  // namespace troffer
