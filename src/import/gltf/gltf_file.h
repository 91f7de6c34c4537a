// Container of a glTF asset: a JSON text alone (.gltf), or a GLB with JSON and binary chunks.
// read_gltf_file only splits the container; gltf_json.h parses the text, gltf_accessor.h reads the
// binary data.
// References: [1] Khronos, glTF 2.0 Specification, §4 (GLB File Format).
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace troffer {

// Contents of a container, split into its chunks.
struct GltfFile {
  std::string json_text;
  std::optional<std::vector<uint8_t>> binary_chunk;  // only in a GLB that has a binary chunk
  bool is_glb = false;
  bool is_out_of_order = false;  // true if the binary chunk is not the second chunk, as [1]
                                 // requires
};

// Reads the file at `path`. The content, not the file's name, decides whether it is a GLB. Ignores
// bytes after the declared length.
// Throws InputError if the file is missing, empty or not glTF, or if a header, length or chunk of a
// GLB violates [1].
GltfFile read_gltf_file(const std::string& path);

}  // namespace troffer
