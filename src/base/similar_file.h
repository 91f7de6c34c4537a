// Which file a mistyped path may have meant.
#pragma once

#include <string>

namespace troffer {

// "; did you mean 'room.gltf'?", by the names in the path's folder; or nothing.
std::string did_you_mean_file(const std::string& path);

}  // namespace troffer
