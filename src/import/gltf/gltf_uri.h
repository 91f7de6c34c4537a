// The files that a glTF document names.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "import/gltf/gltf_json.h"

namespace troffer {

// The path inside `folder` that a relative URI stands for, percent-decoded. Fails at the URI where
// it has a scheme, is malformed, or leads out of the folder (see confined_path).
std::string path_of_uri(const JsonNode& uri, const std::string& folder);

// Contents of the file at `path`; fails at `uri` where it cannot be read.
std::vector<uint8_t> read_file_of_uri(const JsonNode& uri, const std::string& path);

}  // namespace troffer
