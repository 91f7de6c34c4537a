// Radiance's distant sources -> suns, skies and surroundings.
#pragma once

#include <string>

#include "import/radiance/radiance_material.h"

namespace troffer {

// Appends the light of a `source` that lies in the direction `to` (unit) and is `angle_deg` wide,
// with its pattern where it has one (null: none). Hemispheres and the whole sphere that shine
// evenly become a sky and an environment, others an image of their cone: 1024 × 512 texels.
// False: it cannot be used. InputError: its pattern cannot be evaluated.
bool add_radiance_source(const RadianceLook& look, RadiancePattern* pattern, const Vec3d& to,
                         double angle_deg, const std::string& name, Scene& scene);

}  // namespace troffer
