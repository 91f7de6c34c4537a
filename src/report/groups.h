// A scene's lights as a designer counts them: luminaires, and what comes from beyond the scene.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "scene/scene.h"

namespace troffer {

struct ReportedLights {
  std::string name;
  std::vector<std::string> lights;  // names, as Light::name
  size_t luminaires = 0;
  bool is_daylight = false;
  double lumens = 0;            // initial; 0 for daylight
  std::optional<double> watts;  // of all its luminaires; none: unknown
};

// "NODE=W", per luminaire; '*' in a name stands for any letters (base/wildcard.h).
struct PowerRequest {
  std::string name;
  double watts = 0;
};

// Skies, suns, images of the surroundings and distant lights.
bool is_daylight(const Light& light);

// One group per name, in natural order of names; luminaires whose names differ in a number at their
// end alone are together where there are more than `most` groups, and the weakest of those left
// beyond that are "others". watts: as asked for; of several requests that fit, the last. UsageError
// for one that fits no light.
std::vector<ReportedLights> light_groups(const Scene& scene, const std::vector<PowerRequest>& power,
                                         size_t most);

// The scene, such that no name stands for a luminaire and for daylight both.
Scene with_daylight_apart(Scene scene);

// Those of the scene's light names that are daylight, and the others; each once.
std::pair<std::vector<std::string>, std::vector<std::string>> daylight_and_luminaires(
    const Scene& scene);

}  // namespace troffer
