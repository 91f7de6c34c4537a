// Scenes -> pbrt-v4 files.
//
// References: [1] pbrt-v4 Input File Format, pbrt.org/fileformat-v4.
#pragma once

#include <string>
#include <vector>

#include "scene/scene.h"

namespace troffer {

// Writes `path` and, beside it, a folder of its name with "_files" for meshes (PLY) and images.
// Returns what pbrt's format or materials cannot hold, in words. EnvironmentError: files that
// cannot be written.
std::vector<Warning> write_pbrt(const Scene& scene, const std::string& path);

}  // namespace troffer
