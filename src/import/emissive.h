// Makes sources of emissive meshes, by one rule for all formats.
#pragma once

#include <string>

#include "scene/scene.h"

namespace troffer {

// What a format says about the emission of one shape.
struct EmissionSpec {
  std::string name;  // shared by all sources that come of the shape
  Rgb radiance;
  int32_t texture = no_texture;  // factor on radiance
  bool is_two_sided = false;
};

// Makes `scene.meshes[mesh]` emit: each connected component whose triangles form one planar convex
// polygon becomes a polygon source (only where emission has no texture and material no alpha mask);
// all other triangles together become one mesh source. Fills Mesh::lights and appends to
// scene.lights. A mesh without area, or a black emission, adds no source (and the former a
// warning).
void add_mesh_lights(Scene& scene, uint32_t mesh, const EmissionSpec& spec);

}  // namespace troffer
