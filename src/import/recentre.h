// Scenes far from the origin: a place of their own from which positions count, chosen before
// anything is rounded to floats.
#pragma once

#include <array>
#include <functional>
#include <vector>

#include "base/box.h"
#include "base/parallel.h"
#include "import/image_use.h"
#include "scene/scene.h"

namespace troffer {

// Where the things of a file are, in double precision; grows as an importer places them.
class PlacedBounds {
 public:
  // One without area, or farther from the origin than is ever shown, does not count.
  void add_triangle(const Vec3d& a, const Vec3d& b, const Vec3d& c);
  void add_box(const Boxd& box);
  void add_ball(const Vec3d& centre, double radius);
  void add(const PlacedBounds& other) { box_.grow(other.box_); }
  // Those of `count` triangles, on all cores: corners(i) says where their corners are.
  template <class Corners>
  void add_triangles(size_t count, const Corners& corners);
  // at(vertex) says where a vertex is.
  template <class At>
  void add_triangles(const std::vector<Triangle>& triangles, const At& at) {
    add_triangles(triangles.size(), [&](size_t i) {
      const Triangle& t = triangles[i];
      return std::array<Vec3d, 3>{at(t[0]), at(t[1]), at(t[2])};
    });
  }
  const Boxd& box() const { return box_; }

 private:
  Boxd box_;
};

template <class Corners>
void PlacedBounds::add_triangles(size_t count, const Corners& corners) {
  constexpr size_t piece = size_t(1) << 16;
  std::vector<PlacedBounds> parts(count / piece + 1);
  parallel_pieces(count, piece, [&](size_t first, size_t end) {
    PlacedBounds own;
    for (size_t i = first; i < end; ++i) {
      const std::array<Vec3d, 3> c = corners(i);
      own.add_triangle(c[0], c[1], c[2]);
    }
    parts[first / piece] = own;
  });
  for (const PlacedBounds& part : parts) add(part);
}

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
Scene import_recentred(const std::function<void(Scene& scene, PlacedBounds& bounds)>& import,
                       ImageUse images = ImageUse::read);

// A mesh in a space of its own; positions count from `anchor`.
struct AnchoredMesh {
  Mesh mesh;
  Vec3d anchor;
};
// Sets positions and anchor, which is zero unless they lie hundreds of units from zero.
void set_positions(AnchoredMesh& mesh, const std::vector<Vec3d>& positions);

}  // namespace troffer
