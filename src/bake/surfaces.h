// A scene's surfaces as light is baked for them, and as they are written: meshes with charts.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "bake/charts.h"
#include "scene/mesh_in_world.h"
#include "scene/scene.h"

namespace troffer {

// The scene in meshes as a file holds them: round bodies that do not shine as triangles, triangles
// that shine apart from those that do not. Its light is the same, but for what triangles leave of
// round bodies.
Scene as_meshes(Scene scene);

// What gets light of its own: a mesh where it stands.
struct Stand {
  uint32_t charted = 0;  // of BakedSurfaces::charted
  bool is_instance = false;
  uint32_t number = 0;  // of the scene's meshes, or of its instances
  float scale = 1;      // metres in the world for one of the mesh
};

struct BakedSurfaces {
  Scene scene;  // to be written
  std::vector<ChartedMesh>
      charted;                // of meshes, then of instanced ones; of those without light empty
  std::vector<Stand> stands;  // with light
  WarningLog warnings;
  size_t charts = 0, degenerate = 0;  // in all that is stored

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

// Charts for all meshes that neither shine nor are clear glass. Second sets of texture coordinates
// that can hold a lightmap serve as they are laid out; others are replaced, unless textures go by
// them. threads: 0: all cores.
BakedSurfaces surfaces_of(Scene scene, int threads);

// Which sides of a chart get light.
enum class LitSides : uint8_t {
  front,
  back,        // the chart is turned over
  both,        // two layers of triangles, each seen from its front
  front_more,  // both, the back in few texels: it is dark
  back_more,
};

// The surfaces with every chart's sides (one list per BakedSurfaces::charted; empty: fronts): where
// both get light, the mesh is divided.
BakedSurfaces with_sides(BakedSurfaces surfaces, const std::vector<std::vector<LitSides>>& sides);

// Moves layers that lie in one place apart, each to its front by a few roundings of coordinates:
// for readers that show the backs of what shines, as troffer does.
void lift_layers(BakedSurfaces& surfaces);

}  // namespace troffer
