// Finds connected flat faces of a scene that look in one direction: desk tops, floors, boards.
// The searches for floors and desks use them. Coordinates are the file's, lengths in metres.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "base/vec.h"
#include "scene/scene.h"

namespace troffer {

// Connected triangles with one normal.
struct FlatFace {
  std::string name;  // name of the mesh with the largest share of the area
  std::vector<std::array<Vec3d, 3>> triangles;  // in the file's coordinates, m
  double height = 0;                            // mean position along the direction, m
  double area = 0;                              // m²
};

// Returns the triangles whose front looks in the unit direction `towards` within one degree, joined
// where they share a corner (to a tenth of a millimetre). Faces are sorted by falling area. node:
// name of the meshes to search; null: all meshes.
std::vector<FlatFace> flat_faces(const Scene& scene, const Vec3d& towards, const std::string* node);

// True if a mesh or an instance has that name.
bool has_node(const Scene& scene, const std::string& node);

// Returns the unit mean normal of a node's meshes if they are flat within 3 %, else the zero
// vector.
Vec3d facing_of_node(const Scene& scene, const std::string& node);

}  // namespace troffer
