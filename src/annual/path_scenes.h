// Scenes of a year of daylight: one per light path and state (light_paths.h). Groups come from a
// Honeybee model or from a file (window_groups.h). Used by the command annual and the public
// interface.
#pragma once

#include <string>
#include <vector>

#include "annual/light_paths.h"
#include "import/import_options.h"

namespace troffer {

// Where a scene came from: its file is read again for each state of a Honeybee model's groups.
struct SceneOrigin {
  const std::string& file;
  const ImportOptions& options;
};

// Makes the scenes. `shown` is the scene as imported; its windows are open. groups: file of window
// groups, or empty. Groups that ImportOptions::states fixes have that state only. Throws UsageError
// if both the model and the file have groups.
std::vector<LightPath> annual_paths(const SceneOrigin& origin, const Scene& shown,
                                    const std::string& groups);

// True if the windows of a Honeybee model form dynamic groups.
bool has_groups_of_model(const Scene& scene);

// Returns the scene with all lights off.
Scene with_lights_off(Scene scene);

}  // namespace troffer
