// Scenes for the benchmark of direct light, generated: nothing to ship, and as large as wanted.
#pragma once

#include <string>
#include <vector>

#include "scene/scene.h"

namespace troffer::bench {

// Lengths in metres, z up.

// A box turned about its vertical axis by `angle`, radians; its front is inside if is_inward.
void add_box(Mesh& m, const Vec3& lower, const Vec3& upper, float angle = 0,
             bool is_inward = false);
void add_ball(Mesh& m, const Vec3& centre, float radius);
// A parallelogram; its front is where u × v points.
void add_sheet(Mesh& m, const Vec3& corner, const Vec3& u, const Vec3& v);
// A light with corners `corner`, + u, + v; it shines where u × v points.
void add_light(Scene& s, const Vec3& corner, const Vec3& u, const Vec3& v);
// A light of side `size`, facing down.
void add_square_light(Scene& s, const Vec3& centre, float size);

// 32 000 triangles: balls and boxes on and over a table, in a room with two lights.
Scene clutter();
// 100 000 leaves of two triangles, in five crowns under one large light.
Scene foliage();

// What is easily missed: little scenes of a floor, one large and one narrow light above, and
// occluders that are thin, small, or touch something.
struct ThinScene {
  std::string name, what;
  Scene scene;
};
std::vector<ThinScene> thin_scenes();

}  // namespace troffer::bench
