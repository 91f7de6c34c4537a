// A scene as files of other formats hold it: meshes that are of one material and of one light, or
// of none.
#pragma once

#include <vector>

#include "scene/scene.h"

namespace troffer {

constexpr uint32_t no_mesh = 0xffffffffu;

struct ScenePart {
  Mesh mesh;  // only vertices that its triangles use; no lights
  int32_t light = no_light;
  uint32_t number = no_mesh;  // of Scene::meshes, where the part is one of them as it is
};

// All meshes but instanced ones, those of lights first, in the order of the lights. With
// `with_round`, spheres and disks too, as triangles: a light's radiance grows by what its area has
// shrunk, so that its power stays.
struct SceneParts {
  std::vector<ScenePart> parts;
  std::vector<Rgb> radiances;  // of the lights
};
SceneParts parts_of(const Scene& scene, bool with_round);

// Spheres and disks as triangles: 96 around.
Mesh sphere_mesh(const Sphere& sphere);
Mesh disk_mesh(const Disk& disk);
// Those triangles of a mesh, with the vertices that they use.
Mesh extracted(const Mesh& from, const std::vector<Triangle>& triangles);

}  // namespace troffer
