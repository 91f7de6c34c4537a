// Writes meshes as PLY files, binary, little endian, with normals and texture coordinates if the
// mesh has them. PbrtWriter uses it. Positions are in metres.
#pragma once

#include <cstdint>
#include <vector>

#include "scene/scene.h"

namespace troffer {

// Returns a PLY file. Positions are relative to `origin`, as doubles unless that is zero. uvs: per
// vertex, or empty.
std::vector<uint8_t> ply_of(const Mesh& mesh, const std::vector<Vec2>& uvs, const Vec3d& origin);

}  // namespace troffer
