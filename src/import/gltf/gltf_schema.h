// What every glTF document must have before it is used: types, required members, references.
// References: [1] Khronos, glTF 2.0 Specification, §5 (Properties Reference).
#pragma once

#include "base/log.h"
#include "import/gltf/gltf_json.h"

namespace troffer {

// Checks the asset's version, that everything the importer reads has the right JSON type, that
// required members are there, and that every index names something that exists, used or not.
// Fails at the first value that is wrong; a later minor version of the format is a warning.
void check_gltf_document(const JsonNode& root, WarningLog& warnings);

// Fails on a required extension that is not supported; an optional one becomes a warning.
void check_gltf_extensions(const JsonNode& root, WarningLog& warnings);

}  // namespace troffer
