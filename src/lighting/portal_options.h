// --portal: rectangles that are the only way for environment light into a scene. add_daylight()
// uses it after all lights are added. Coordinates are those of the scene file, in metres.
#pragma once

#include <string>
#include <vector>

#include "scene/scene.h"

namespace troffer {

// Restricts every environment light without a portal to the given rectangles. Each is twelve
// numbers x,y,z or the name of a part of the scene. With several rectangles a light is copied, one
// for each. Throws UsageError if a text is no rectangle or two rectangles overlap.
void add_portals(Scene& scene, const std::vector<std::string>& portals);

}  // namespace troffer
