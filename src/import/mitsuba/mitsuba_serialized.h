// Mitsuba's compressed mesh files.
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
  AnchoredMesh mesh;  // normals and (u,v) where the file has some
  bool has_face_normals = false;
};

// The mesh number `index` of that file's contents. InputError{path, 0, 0, what}: no such mesh, data
// that is cut short or broken, indices out of range, more than 60 million triangles. Memory stays
// in proportion to what the data expand to.
SerializedMesh read_serialized(std::span<const uint8_t> file, size_t index,
                               const std::string& path);

}  // namespace troffer
