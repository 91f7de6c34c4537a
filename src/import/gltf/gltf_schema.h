// Structural checks of a glTF document before it is used: JSON types, required members, references.
// The importer runs them first, so that later code can follow references without checking them
// again.
// References: [1] Khronos, glTF 2.0 Specification, §5 (Properties Reference).
#pragma once

#include "base/log.h"
#include "import/gltf/gltf_json.h"

namespace troffer {

// Checks the asset's version, the presence of required members, and the JSON type of everything
// that the importer reads. Also checks every index, whether it is used or not.
// Fails at the first wrong value. Warns if the file asks for a later minor version.
void check_gltf_document(const JsonNode& root, WarningLog& warnings);

// Warns of each extension that is not supported, required or not.
void check_gltf_extensions(const JsonNode& root, WarningLog& warnings);

}  // namespace troffer
