// Suggests the file that a mistyped path may have meant. Used in error messages about missing
// files.
#pragma once

#include <string>

namespace troffer {

// Returns "; did you mean 'room.gltf'?" from the names in the path's folder, or an empty string.
std::string did_you_mean_file(const std::string& path);

}  // namespace troffer
