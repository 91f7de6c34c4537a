// Shapes of surface lights as a camera sees them: outlines, and the pieces that emit towards the
// eye. Used by LightOutlines. Positions are in world space, metres.
#pragma once

#include <vector>

#include "render/camera.h"
#include "scene/scene.h"

namespace troffer {

struct OutlineEdge {
  Vec3 a, b;
  // distance before the edge within which the light may hide itself, metres
  float hidden_before = 0;
};

// Adds the edges of a light's outline. Disks and spheres become polygons that are as round as the
// picture can show.
void add_outline(const Scene& scene, const Light& light, const ViewingCamera& camera,
                 std::vector<OutlineEdge>& edges);

// True if the light has the same radiance everywhere and in all directions.
bool is_even(const Light& light);

// A corner of a convex polygon in space.
struct LightCorner {
  Vec3 position;
  bool is_outline = true;  // the side to the next corner borders no other piece
};
using LightLoop = std::vector<LightCorner>;

// Returns the pieces of a light that emit towards the eye.
std::vector<LightLoop> shining_loops(const Scene& scene, const Light& light,
                                     const ViewingCamera& camera);

}  // namespace troffer
