// Lights with a surface, as a camera has them before it: their outlines, and the pieces that shine.
#pragma once

#include <vector>

#include "render/camera.h"
#include "scene/scene.h"

namespace troffer {

struct OutlineEdge {
  Vec3 a, b;
  float hidden_before = 0;  // metres before it a light may be in its own way
};

// Adds the edges of a light's outline, in space. Disks and spheres are polygons that are as round
// as can be told in the picture.
void add_outline(const Scene& scene, const Light& light, const ViewingCamera& camera,
                 std::vector<OutlineEdge>& edges);

// A light that looks alike wherever it is seen.
bool is_even(const Light& light);

// A convex polygon in space.
struct LightCorner {
  Vec3 position;
  bool is_outline = true;  // the side from here to the next corner is no other piece's
};
using LightLoop = std::vector<LightCorner>;

// A light's pieces that shine towards the eye.
std::vector<LightLoop> shining_loops(const Scene& scene, const Light& light,
                                     const ViewingCamera& camera);

}  // namespace troffer
