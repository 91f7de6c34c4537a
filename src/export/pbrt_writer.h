// Writes scenes as pbrt-v4 files. export_scene() uses it. Emission is in W/(m² sr).
//
// References: [1] pbrt-v4 Input File Format, pbrt.org/fileformat-v4.
#pragma once

#include <string>
#include <vector>

#include "export/output_folder.h"
#include "scene/scene.h"

namespace troffer {

// Writes the scene file, with meshes (PLY) and images in its folder. Returns warnings about what
// pbrt's format or materials cannot express. Throws EnvironmentError for files that cannot be
// written.
std::vector<Warning> write_pbrt(const Scene& scene, OutputFolder& files);

}  // namespace troffer
