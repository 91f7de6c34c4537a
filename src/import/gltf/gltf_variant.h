// Which material a primitive has in a chosen variant.
// References: [1] Khronos extension KHR_materials_variants.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "base/log.h"
#include "import/gltf/gltf_json.h"

namespace troffer {

// The variant of that name: its index in [1]'s list. UsageError that lists the names if there is
// none. Without a name: none, and a warning if the file has variants.
std::optional<uint32_t> find_gltf_variant(const JsonNode& root,
                                          const std::optional<std::string>& name,
                                          WarningLog& warnings);

// The material that [1] gives the primitive in that variant; none: its own. Fails where an index is
// out of range.
std::optional<uint32_t> gltf_variant_material(const JsonNode& root, const JsonNode& primitive,
                                              uint32_t variant);

}  // namespace troffer
