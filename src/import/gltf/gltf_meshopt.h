// Compressed buffer views.
// References: [1] Khronos extension EXT_meshopt_compression.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "import/gltf/gltf_json.h"

namespace troffer {

// The object of [1] in a buffer view, if it has one. (KHR_meshopt_compression is the same but for
// newer codecs, at which decoding fails.)
std::optional<JsonNode> meshopt_extension(const JsonNode& view);

// What `compressed`, the range that the extension names, stands for: `byte_length` bytes, at most
// 256 times as many as the compressed ones and a few. Fails at the extension where it is malformed
// or the data is broken.
std::vector<uint8_t> decode_meshopt(const JsonNode& extension, std::span<const uint8_t> compressed,
                                    uint64_t byte_length);

}  // namespace troffer
