// Scenes -> pbrt-v4 files.
//
// References: [1] pbrt-v4 Input File Format, pbrt.org/fileformat-v4.
#pragma once

#include <string>
#include <vector>

#include "export/output_folder.h"
#include "scene/scene.h"

namespace troffer {

// Writes a scene's file, with meshes (PLY) and images in the folder beside it.
// Returns what pbrt's format or materials cannot hold, in words. EnvironmentError: files that
// cannot be written.
std::vector<Warning> write_pbrt(const Scene& scene, OutputFolder& files);

}  // namespace troffer
