// Lights that lie exactly in each other's place.
#pragma once

#include "scene/scene.h"

namespace troffer {

// The scene with such lights joined: the first one sends what all of them did, and the surfaces of
// the others are gone. Two surfaces in one place hide each other or not as rounding wills, and a
// ray that arrives meets one of them: every method would count something else. Spheres, disks,
// polygons and meshes count that have the same corners and shine to the same sides, without image
// or mask.
Scene with_joined_lights(Scene scene);

}  // namespace troffer
