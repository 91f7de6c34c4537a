// Facts about a scene's sources, for people.
#pragma once

#include <vector>

#include "scene/scene.h"

namespace troffer {

struct SourceInfo {
  double area = 0;   // m², one side
  double power = 0;  // luminance of the flux that leaves: W, or lm where the scene is photometric
};

// One per light.
std::vector<SourceInfo> source_infos(const Scene& scene);

}  // namespace troffer
