// Radiance's distant sources -> suns, skies and even surroundings.
//
// References: [1] Radiance's skybright.cal and manual page gensky(1); [2] CIE S 011/E:2003,
// "Spatial
//   distribution of daylight - CIE standard general sky".
#pragma once

#include <string>

#include "base/transform.h"
#include "import/radiance_material.h"

namespace troffer {

// Appends the light of a `source` that lies in the direction `to` (unit) and is `angle_deg` wide.
// False: it cannot be used. `world` turns what its sky's pattern says of directions.
bool add_radiance_source(const RadianceLook& look, const Vec3d& to, double angle_deg,
                         const Affine& world, const std::string& name, Scene& scene);

}  // namespace troffer
