// Radiance of an environment image by direction, and the table for sampling it. Used by environment
// and point lights.
#pragma once

#include <memory>

#include "light/direction_table.h"
#include "scene/environment_map.h"

namespace troffer {

// Bilinear between texel centres, and continuous across the square's edges where the sphere is.
Rgb radiance_towards(const EnvironmentMap& map, const Vec3& w);
// Returns the table for sampling directions in proportion to the image's luminance.

DirectionTable direction_table(const EnvironmentMap& map);

}  // namespace troffer
