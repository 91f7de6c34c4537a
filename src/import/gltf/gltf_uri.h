// Relative URIs in a glTF document: the files that they name, and the contents of those files. Used
// for buffers, photometric profiles and the images of image-based lights. Data URIs are decoded by
// import/uri.h, texture images are found by gltf_texture.h. Nothing outside the scene's folder is
// read.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "import/gltf/gltf_json.h"

namespace troffer {

// Returns the percent-decoded path inside `folder` that the relative URI names. Fails at the URI if
// it has a scheme, is malformed or leads out of the folder (see confined_path).
std::string path_of_uri(const JsonNode& uri, const std::string& folder);

// Returns the contents of the file at `path`. Fails at `uri` if the file cannot be read.
std::vector<uint8_t> read_file_of_uri(const JsonNode& uri, const std::string& path);

}  // namespace troffer
