// --dim: lights of a scene made weaker or stronger, by name; and whether any shines at all.
#pragma once

#include <string>
#include <vector>

#include "scene/scene.h"

namespace troffer {

// Whether any light of the scene sends something. Images are taken to.
bool shines(const Scene& scene);

// Each "NAME=F": lights of that name (base/wildcard.h) send F times as much; of several that fit a
// light the last counts. UsageError for other texts, and for names that no light has.
void dim_lights(Scene& scene, const std::vector<std::string>& dims);

// Factor on the light of that name: 1 where nothing fits it.
double dimming_of(const std::string& name, const std::vector<std::string>& dims);

}  // namespace troffer
