// Lights from emissive meshes, by one rule for all formats. Polygon lights allow certified
// visibility and exact irradiance, so meshes become polygons where possible. Radiance is in the
// scene's unit (Scene::is_photometric).
#pragma once

#include <string>

#include "scene/scene.h"

namespace troffer {

// Emission of one shape, as a format describes it.
struct EmissionSpec {
  std::string name;  // shared by all lights that result from the shape
  Rgb radiance;
  int32_t texture = no_texture;  // factor on radiance
  bool is_two_sided = false;
};

// Makes `scene.meshes[mesh]` emit. Fills Mesh::lights and appends to scene.lights.
// Each connected component whose triangles form one planar convex polygon becomes a polygon light,
// unless the emission has a texture or the material an alpha mask. All other triangles together
// become one mesh light.
// A black emission adds no light. A mesh without area adds none either, with a warning.
void add_mesh_lights(Scene& scene, uint32_t mesh, const EmissionSpec& spec);

}  // namespace troffer
