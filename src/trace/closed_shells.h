// Proves that a point is enclosed by opaque surfaces, without rays. Light from infinity is skipped
// for such points.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "base/vec.h"
#include "scene/scene.h"
#include "trace/panes.h"

namespace troffer {

// The insides of closed surfaces of opaque triangles, such as a room whose floor, walls and ceiling
// share vertices. Immutable and thread safe after construction.
class ClosedShells {
 public:
  ClosedShells() = default;
  // glass: null if there are no panes.
  ClosedShells(const Scene& scene, const PaneGlass* glass);

  bool is_empty() const { return shells_.empty(); }
  // True if every path from p to infinity provably meets a triangle. False if that is not known.
  bool hold(const Vec3& p) const;

 private:
  using Corners = std::array<Vec3, 3>;

  // A closed surface, with its triangles in a grid across one direction.
  struct Shell {
    Vec3d lower, upper;
    Vec2d from, per_cell;  // lower corner of the grid, and its cells per metre
    int cells = 1;         // per side
    std::vector<uint32_t> first, of_cell;
    std::vector<Corners> triangles;

    explicit Shell(std::vector<Corners> all);
    bool holds(const Vec3& p) const;
    std::array<int, 2> cell_of(const Vec2d& at) const;
  };
  std::vector<Shell> shells_;  // largest first
};

}  // namespace troffer
