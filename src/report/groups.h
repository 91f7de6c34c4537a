// Groups a scene's lights as a designer counts them: luminaires, and daylight.
// assess() measures each group; tables of the report list them. Flux is in lm, power in W.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "scene/scene.h"

namespace troffer {

// A group of lights.
struct ReportedLights {
  std::string name;
  std::vector<std::string> lights;  // light names, as in Light::name
  size_t luminaires = 0;
  bool is_daylight = false;
  double lumens = 0;            // initial flux, lm; 0 for daylight
  std::optional<double> watts;  // power of all its luminaires, W; empty if unknown
};

// Electric power per luminaire, from "NODE=W"; '*' in a name stands for any letters
// (base/wildcard.h).
struct PowerRequest {
  std::string name;
  double watts = 0;
};

// True for skies, suns, environment images and distant lights.
bool is_daylight(const Light& light);

// Returns one group per name, in natural order of names. If there are more than `most` groups,
// luminaires whose names differ only in a number at the end are joined. The weakest groups beyond
// `most` then become "others". watts: the last request that fits. Throws UsageError for a request
// that fits no light.
std::vector<ReportedLights> light_groups(const Scene& scene, const std::vector<PowerRequest>& power,
                                         size_t most);

// Renames daylight so that no name belongs to both a luminaire and daylight.
Scene with_daylight_apart(Scene scene);

// Returns the names of daylight and the names of luminaires, each name once.
std::pair<std::vector<std::string>, std::vector<std::string>> daylight_and_luminaires(
    const Scene& scene);

}  // namespace troffer
