// The scenes of `troffer annual`: one per light path and state (annual/light_paths.h). Groups come
// from a Honeybee model or from --groups.
#pragma once

#include <string>
#include <vector>

#include "annual/light_paths.h"
#include "app/commands.h"

namespace troffer {

// Makes the scenes. `shown` is the scene of the file as imported; its windows are open. groups:
// file of --groups, or empty. Groups that --state fixes have that state only. Throws UsageError if
// both the model and the file have groups.
std::vector<LightPath> annual_paths(const SceneChoice& choice, const Scene& shown,
                                    const std::string& groups);

// Returns the scene with all lights off.
Scene with_lights_off(Scene scene);

}  // namespace troffer
