// Joins lights with identical geometry. Used when a scene is loaded, before anything numbers its
// lights.
#pragma once

#include "scene/scene.h"

namespace troffer {

// Returns the scene with such lights joined: the first one emits the sum, and the other surfaces
// are removed. Two coincident surfaces hide each other as rounding decides, and a ray hits only one
// of them, so methods would disagree about their light. Joins spheres, disks, polygons and meshes
// with the same corners and emitting sides, without image, mask or web.
Scene with_joined_lights(Scene scene);

}  // namespace troffer
