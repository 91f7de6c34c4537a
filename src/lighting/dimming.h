// --dim: scales lights of a scene by name. Also tests whether any light emits. add_daylight() uses
// it, and the report command for the power of dimmed luminaires.
#pragma once

#include <string>
#include <vector>

#include "scene/scene.h"

namespace troffer {

// True if any light of the scene emits. Images are assumed to.
bool shines(const Scene& scene);

// Scales lights; each text is "NAME=F", and NAME may hold wildcards (base/wildcard.h). If several
// match a light, the last one applies. Throws UsageError for malformed texts and for names that
// match no light.
void dim_lights(Scene& scene, const std::vector<std::string>& dims);

// Returns the factor on the light of that name: 1 if nothing matches.
double dimming_of(const std::string& name, const std::vector<std::string>& dims);

}  // namespace troffer
