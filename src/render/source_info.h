// Area and power of a scene's lights, for the command info, reports and the viewer.
#pragma once

#include <vector>

#include "scene/scene.h"

namespace troffer {

struct SourceInfo {
  double area = 0;   // m², one side
  double power = 0;  // emitted flux (its luminance): W, or lm in photometric scenes
};

// Returns one entry per light.
std::vector<SourceInfo> source_infos(const Scene& scene);

}  // namespace troffer
