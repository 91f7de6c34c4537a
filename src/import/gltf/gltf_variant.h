// Material variants of glTF (`--variant NAME`): the material of each primitive in a chosen variant.
// gltf.cpp applies the choice when it reads primitives.
// References: [1] Khronos extension KHR_materials_variants.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "base/log.h"
#include "import/gltf/gltf_json.h"

namespace troffer {

// Returns the index of the named variant in [1]'s list. Throws UsageError that lists the names if
// there is none of that name. Without a name it returns nothing, and warns if the file has
// variants.
std::optional<uint32_t> find_gltf_variant(const JsonNode& root,
                                          const std::optional<std::string>& name,
                                          WarningLog& warnings);

// Returns the material of the primitive in that variant; nothing if the primitive keeps its own.
// Fails if an index is out of range.
std::optional<uint32_t> gltf_variant_material(const JsonNode& root, const JsonNode& primitive,
                                              uint32_t variant);

}  // namespace troffer
