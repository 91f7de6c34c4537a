// Generated scenes for the benchmark of direct light, of any size. Lengths in metres, z up.
#pragma once

#include <string>
#include <vector>

#include "scene/scene.h"

namespace troffer::bench {

// Adds a box turned about its vertical axis by `angle`, radians; its front is inside if is_inward.
void add_box(Mesh& m, const Vec3& lower, const Vec3& upper, float angle = 0,
             bool is_inward = false);
void add_ball(Mesh& m, const Vec3& centre, float radius);
// Adds a parallelogram; its front faces along u × v.
void add_sheet(Mesh& m, const Vec3& corner, const Vec3& u, const Vec3& v);
// Adds a light with corners `corner`, + u, + v; it emits toward u × v.
void add_light(Scene& s, const Vec3& corner, const Vec3& u, const Vec3& v);
// Adds a light with sides `size`, facing down.
void add_square_light(Scene& s, const Vec3& centre, float size);

// Returns 32 000 triangles: balls and boxes on and above a table, in a room with two lights.
Scene clutter();
// Returns 100 000 leaves of two triangles, in five crowns under one large light.
Scene foliage();

// A small scene with occluders that are easily missed: thin, small, or touching something. It has a
// floor, and a large and a narrow light above.
struct ThinScene {
  std::string name, what;
  Scene scene;
};
std::vector<ThinScene> thin_scenes();

}  // namespace troffer::bench
