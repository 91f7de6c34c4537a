// Reader of Mitsuba's compressed mesh files (.serialized), which hold several meshes. Used by
// MitsubaShapes. The data may be hostile: sizes and indices are checked.
//
// References: [1] W. Jakob, "Mitsuba 0.6 Documentation", §8.1 (Serialized mesh loader: the file
//   format, versions 3 and 4).
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "import/recentre.h"

namespace troffer {

struct SerializedMesh {
  AnchoredMesh mesh;  // with normals and (u,v) if the file has them
  bool has_face_normals = false;
};

// Returns mesh number `index` of the file's contents. Throws InputError{path, 0, 0, what} for a
// missing mesh, truncated or broken data, indices out of range, and more than 60 million triangles.
// Memory is proportional to the expanded data.
SerializedMesh read_serialized(std::span<const uint8_t> file, size_t index,
                               const std::string& path);

}  // namespace troffer
