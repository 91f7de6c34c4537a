// Lights without surface -> pbrt's LightSource.
#pragma once

#include <string>

#include "export/output_folder.h"
#include "scene/scene.h"

namespace troffer {

// The directives of all lights of the scene that have no surface, their radiance times `unit`; what
// cannot be written is a warning that names it.
std::string pbrt_lights(const Scene& scene, double unit, OutputFolder& files, WarningLog& warnings);

}  // namespace troffer
