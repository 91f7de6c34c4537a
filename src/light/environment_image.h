// Images of environments: radiance by direction, and the table by which they are sampled.
#pragma once

#include <memory>

#include "light/direction_table.h"
#include "scene/environment_map.h"

namespace troffer {

// Bilinear between texel centres, across the edges of the square as the sphere goes on.
Rgb radiance_towards(const EnvironmentMap& map, const Vec3& w);

DirectionTable direction_table(const EnvironmentMap& map);

}  // namespace troffer
