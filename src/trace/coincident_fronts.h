// Finds one-sided triangles that lie back to back: the same three corners, facing opposite ways.
// A ray that meets such a pair has to get the triangle that faces it, whichever the tree finds
// first.
#pragma once

#include <cstdint>
#include <vector>

#include "scene/scene.h"

namespace troffer {

// For each mesh of `scene`, one flag per triangle: its back coincides with the front of another
// one-sided triangle (BackFaces::unseen). Meshes without such triangles have an empty list. Corners
// count as the same where their positions are equal, bit for bit. Instances are not compared.
std::vector<std::vector<uint8_t>> coincident_fronts(const Scene& scene);

}  // namespace troffer
