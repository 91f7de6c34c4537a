// A scene as other formats store it: meshes with one material and at most one light. The glTF and
// pbrt exporters and the baker use it. It also converts spheres and disks to triangles.
#pragma once

#include <vector>

#include "scene/scene.h"

namespace troffer {

constexpr uint32_t no_mesh = 0xffffffffu;

struct ScenePart {
  Mesh mesh;  // only vertices that its triangles use; without lights
  int32_t light = no_light;
  uint32_t number = no_mesh;  // index in Scene::meshes, if the part is a whole mesh
};

// Returns all meshes except instanced ones, those of lights first, in the order of the lights. With
// `with_round`, also spheres and disks as triangles; the radiance of a light is scaled to keep its
// power.
struct SceneParts {
  std::vector<ScenePart> parts;
  std::vector<Rgb> radiances;  // per light
};
SceneParts parts_of(const Scene& scene, bool with_round);

// Return spheres and disks as triangles, with 96 segments around.
Mesh sphere_mesh(const Sphere& sphere);
Mesh disk_mesh(const Disk& disk);
// Returns a mesh of these triangles, with the vertices that they use.
Mesh extracted(const Mesh& from, const std::vector<Triangle>& triangles);

}  // namespace troffer
