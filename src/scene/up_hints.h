// Hints in a scene's content at which way is up. scene/orientation.h weighs them against each other
// and against what the file's format says.
#pragma once

#include <string>
#include <vector>

#include "scene/scene.h"

namespace troffer {

struct UpHint {
  Vec3 up;             // unit, along an axis
  double weight = 0;   // 1: weak, 3: strong
  std::string source;  // "its cameras": what gives the hint, as the end of "z is up by …"
};

// Strongest first. The sources: skies and images of surroundings, cameras, names of floors and
// ceilings, objects that stand on others, lamps that face down, a sun, a ground that is alone.
std::vector<UpHint> up_hints(const Scene& scene);

}  // namespace troffer
