// Prepares a scene's surfaces for baking and for export: meshes with charts. bake() uses it.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "bake/charts.h"
#include "scene/mesh_in_world.h"
#include "scene/scene.h"

namespace troffer {

// Returns the scene with the meshes of an exported file: spheres and disks that do not emit become
// triangles, and emitting triangles get meshes of their own. Light is unchanged except for the
// tessellation.
Scene as_meshes(Scene scene);

// A surface that is lit separately: a mesh in one place.
struct Stand {
  uint32_t charted = 0;  // index into BakedSurfaces::charted
  bool is_instance = false;
  uint32_t number = 0;  // index into the scene's meshes, or instances
  float scale = 1;      // world metres per metre of the mesh
};

// Surfaces of a scene with their charts.
struct BakedSurfaces {
  Scene scene;  // scene to write
  // Charts of meshes, then of instanced meshes; empty for those without baked light.
  std::vector<ChartedMesh> charted;
  std::vector<Stand> stands;  // surfaces with baked light
  WarningLog warnings;
  size_t charts = 0, degenerate = 0;  // counted over stored meshes

  MeshInWorld mesh(const Stand& stand) const {
    return stand.is_instance
               ? MeshInWorld(scene.instanced_meshes[scene.instances[stand.number].mesh],
                             &scene.instances[stand.number])
               : MeshInWorld(scene.meshes[stand.number]);
  }
  const std::vector<Chart>& charts_of(const Stand& stand) const {
    return charted[stand.charted].charts;
  }
};

// Makes charts for all meshes that neither emit nor are clear glass. A second set of texture
// coordinates is kept if it can hold a lightmap. Otherwise it is replaced, unless textures use it.
// threads: 0: all cores.
BakedSurfaces surfaces_of(Scene scene, int threads);

// Sides of a chart that get light.
enum class LitSides : uint8_t {
  front,
  back,        // the chart is flipped
  both,        // two layers of triangles, each visible from its front
  front_more,  // both sides; the dark back gets few texels
  back_more,
};

// Divides meshes whose charts get light on both sides. sides: one list per BakedSurfaces::charted;
// an empty list means fronts only.
BakedSurfaces with_sides(BakedSurfaces surfaces, const std::vector<std::vector<LitSides>>& sides);

// Moves two layers at the same place apart, each towards its front by a few rounding errors of
// coordinates. Some readers, troffer among them, show the backs of emitting surfaces and would
// otherwise show the wrong layer.
void lift_layers(BakedSurfaces& surfaces);

}  // namespace troffer
