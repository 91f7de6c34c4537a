// Meshes -> PLY files, binary, little endian.
#pragma once

#include <cstdint>
#include <vector>

#include "scene/scene.h"

namespace troffer {

// Positions from `origin`, in doubles unless that is zero. uvs: empty, or per vertex.
std::vector<uint8_t> ply_of(const Mesh& mesh, const std::vector<Vec2>& uvs, const Vec3d& origin);

}  // namespace troffer
