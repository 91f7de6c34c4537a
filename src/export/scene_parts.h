// A scene as files of other formats hold it: meshes that are of one material and of one light, or
// of none.
#pragma once

#include <vector>

#include "scene/scene.h"

namespace troffer {

struct ScenePart {
  Mesh mesh;  // only vertices that its triangles use; no lights
  int32_t light = no_light;
};

// All meshes but instanced ones, those of lights first, in the order of the lights. With `with_round`, spheres and
// disks too, as triangles: a light's radiance grows by what its area has shrunk, so that its power
// stays.
struct SceneParts {
  std::vector<ScenePart> parts;
  std::vector<Rgb> radiances;  // of the lights
};
SceneParts parts_of(const Scene& scene, bool with_round);

}  // namespace troffer
