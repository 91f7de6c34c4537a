// Connected flat faces of a scene that look one way: desk tops, floors, boards.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "base/vec.h"
#include "scene/scene.h"

namespace troffer {

struct FlatFace {
  std::string name;                             // of the mesh with the largest part of it
  std::vector<std::array<Vec3d, 3>> triangles;  // in the file's coordinates, m
  double height = 0;                            // along the direction, m
  double area = 0;                              // m²
};

// Triangles whose front looks in the unit direction `towards`, within a degree, together where they
// share a corner (to a tenth of a millimetre); by falling area. node: null: of all meshes, else of
// those of that name.
std::vector<FlatFace> flat_faces(const Scene& scene, const Vec3d& towards, const std::string* node);

// Whether a mesh or an instance has that name.
bool has_node(const Scene& scene, const std::string& node);

// Where a node's meshes look as a whole: the unit mean normal where they are flat (within 3 %),
// else the zero vector.
Vec3d facing_of_node(const Scene& scene, const std::string& node);

}  // namespace troffer
