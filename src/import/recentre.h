// Scenes far from the origin: a place of their own from which positions count, chosen before
// anything is rounded to floats.
#pragma once

#include <functional>
#include <vector>

#include "base/box.h"
#include "scene/scene.h"

namespace troffer {

// Where the things of a file are, in double precision; grows as an importer places them.
class PlacedBounds {
 public:
  // One without area, or farther from the origin than is ever shown, does not count.
  void add_triangle(const Vec3d& a, const Vec3d& b, const Vec3d& c);
  void add_box(const Boxd& box);
  void add_ball(const Vec3d& centre, double radius);
  const Boxd& box() const { return box_; }

 private:
  Boxd box_;
};

// The middle of the box, rounded along each axis to a multiple of a step that is 1, 5, 10, 50 … and
// at least `least_step` and about twice as long as the box: so it is zero unless the box lies far
// from the origin for its size, and moves with a box that is moved by a multiple of the step.
Vec3d rounded_middle(const Boxd& box, double least_step);

// The origin (Scene::origin) of a scene whose geometry lies in that box: its rounded_middle(), the
// step at least 100, or 100 times the box where that is smaller than 1.
Vec3d choose_origin(const Boxd& box);

// Imports a scene with the origin that suits it. `import` fills a new scene, all positions counted
// from its origin, as the bounds are; it is called again where zero, tried first, is not that
// origin. A scene too large for floats gets a warning that says how far its ends are rounded.
Scene import_recentred(const std::function<void(Scene& scene, PlacedBounds& bounds)>& import);

// A mesh in a space of its own; positions count from `anchor`.
struct AnchoredMesh {
  Mesh mesh;
  Vec3d anchor;
};
// Sets positions and anchor, which is zero unless they lie hundreds of units from zero.
void set_positions(AnchoredMesh& mesh, const std::vector<Vec3d>& positions);

}  // namespace troffer
