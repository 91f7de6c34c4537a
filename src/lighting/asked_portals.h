// --portal: the rectangles that light from beyond a scene comes through alone.
#pragma once

#include <string>
#include <vector>

#include "scene/scene.h"

namespace troffer {

// All light from beyond the scene that has no portal of its own comes through these: each is twelve
// numbers, or the name of a part of the scene. Of such a light there is one for each rectangle.
// UsageError for what is no rectangle, and for two that overlap.
void add_portals(Scene& scene, const std::vector<std::string>& portals);

}  // namespace troffer
