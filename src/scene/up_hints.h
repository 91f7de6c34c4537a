// Hints in a scene's content at which way is up. scene/orientation.h weighs them against each other
// and against the file's format.
#pragma once

#include <string>
#include <vector>

#include "scene/scene.h"

namespace troffer {

struct UpHint {
  Vec3 up;             // unit, along an axis
  double weight = 0;   // 1: weak, 3: strong
  std::string source;  // end of the sentence "z is up by its cameras"
};

// Returns hints, strongest first. Sources: skies and environment images, cameras, names of floors
// and ceilings, standing objects, lamps that face down, the sun, a lone ground.
std::vector<UpHint> up_hints(const Scene& scene);

}  // namespace troffer
