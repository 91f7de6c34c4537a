// Points and spots that are given a size.
#pragma once

#include "scene/scene.h"

namespace troffer {

// Every point and spot of the scene becomes a sphere of this radius (m) about its place that sends
// as much light in each direction as before, seen from far away, so that shadows are soft. It is
// black to other light. Those that throw images stay points; ranges are left aside; both are
// warnings.
void give_radius(Scene& scene, double radius);

}  // namespace troffer
