// Origins for scenes far from zero. Georeferenced scenes would lose digits in single precision, so
// positions are counted from Scene::origin, which is chosen before any rounding. Importers wrap
// their work in import_recentred() and report their geometry to PlacedBounds.
#pragma once

#include <array>
#include <functional>
#include <vector>

#include "base/box.h"
#include "base/parallel.h"
#include "import/image_use.h"
#include "scene/scene.h"

namespace troffer {

// Bounding box of a file's geometry, in double precision. Importers extend it as they place shapes.
class PlacedBounds {
 public:
  // Adds a triangle. Ignores one without area, or farther than 1e9 from the origin.
  void add_triangle(const Vec3d& a, const Vec3d& b, const Vec3d& c);
  void add_box(const Boxd& box);
  void add_ball(const Vec3d& centre, double radius);
  void add(const PlacedBounds& other) { box_.grow(other.box_); }
  // Adds `count` triangles in parallel. corners(i) returns the three corners of triangle i.
  template <class Corners>
  void add_triangles(size_t count, const Corners& corners);
  // Adds triangles. at(vertex) returns the position of a vertex.
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

// Returns the centre of the box, rounded along each axis to a multiple of a step. The step is 1, 5,
// 10, 50, …, at least `least_step` and about twice the box.
// The result is zero unless the box is far from the origin for its size. It moves with a box that
// moves by a multiple of the step.
Vec3d rounded_middle(const Boxd& box, double least_step);

// Returns the origin (Scene::origin) for geometry in that box: a rounded_middle(). It is zero
// unless the box is farther away than about 100, or 100 times the box if that is smaller than 1.
Vec3d choose_origin(const Boxd& box);

// Imports a scene with a suitable origin. `import` fills a new scene and bounds, with all positions
// counted from Scene::origin. It is called with origin zero, and again if that is not suitable.
// Warns if a scene is too large for single precision, with the resolution at its ends.
Scene import_recentred(const std::function<void(Scene& scene, PlacedBounds& bounds)>& import,
                       ImageUse images = ImageUse::read);

// A mesh in a space of its own; positions count from `anchor`.
struct AnchoredMesh {
  Mesh mesh;
  Vec3d anchor;
};
// Sets the positions and the anchor. The anchor is zero unless the positions lie hundreds of units
// away.
void set_positions(AnchoredMesh& mesh, const std::vector<Vec3d>& positions);

}  // namespace troffer
