// The container of a glTF asset: a JSON text alone (.gltf) or a GLB with a binary chunk.
// References: [1] Khronos, glTF 2.0 Specification, §4 (GLB File Format).
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace troffer {

struct GltfFile {
  std::string json_text;
  std::optional<std::vector<uint8_t>> binary_chunk;  // GLB only
  bool is_glb = false;
  bool is_out_of_order = false;  // the binary chunk is not the second one, as it must be
};

// Sent apart by content; InputError where the file is missing, empty, no glTF, or a GLB of which
// a header, length or chunk is not as [1] says. Bytes behind the declared length are ignored.
GltfFile read_gltf_file(const std::string& path);

}  // namespace troffer
