// Decoder of compressed buffer views, by the library meshoptimizer. GltfBuffers uses it when it
// loads the buffer views of a document.
// References: [1] Khronos extension EXT_meshopt_compression.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "import/gltf/gltf_json.h"

namespace troffer {

// Returns the object of [1] in a buffer view, if it has one. Accepts KHR_meshopt_compression too,
// which differs only in newer codecs; decode_meshopt fails on those.
std::optional<JsonNode> meshopt_extension(const JsonNode& view);

// Decodes `compressed`, the range that the extension names, into `byte_length` bytes. These may be
// at most 256 times as many as the compressed ones, plus 4096.
// Fails at the extension if it is malformed or the data is broken.
std::vector<uint8_t> decode_meshopt(const JsonNode& extension, std::span<const uint8_t> compressed,
                                    uint64_t byte_length);

}  // namespace troffer
