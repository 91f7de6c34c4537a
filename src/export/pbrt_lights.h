// Writes lights without a surface (points, spots, distant lights, skies, environments) as pbrt's
// LightSource. PbrtWriter uses it; emitting surfaces are written there. Images go to the output
// folder.
#pragma once

#include <string>

#include "export/output_folder.h"
#include "scene/scene.h"

namespace troffer {

// Returns the directives of all lights without a surface, with radiance times `unit`. Adds a
// warning for each property that cannot be written.
std::string pbrt_lights(const Scene& scene, double unit, OutputFolder& files, WarningLog& warnings);

}  // namespace troffer
