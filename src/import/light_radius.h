// Radius for point and spot lights (`--light-radius`), so that their shadows become soft. Applied
// to a scene after its import.
#pragma once

#include "scene/scene.h"

namespace troffer {

// Turns every point and spot light into a sphere of this radius (m) around its position. Seen from
// far away it sends the same light in each direction. Its surface is black to other light.
// Lights that project images stay points, and ranges are ignored; both with a warning.
void give_radius(Scene& scene, double radius);

}  // namespace troffer
