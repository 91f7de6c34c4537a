// Whether a place is closed off from all that lies outside the scene: proved, without a ray.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "base/vec.h"
#include "scene/scene.h"
#include "trace/panes.h"

namespace troffer {

// The inside of closed surfaces of opaque triangles, as a room's floor, walls and ceiling are where
// they meet in the same vertices.
class ClosedShells {
 public:
  ClosedShells() = default;
  // glass: null: there are no panes.
  ClosedShells(const Scene& scene, const PaneGlass* glass);

  bool is_empty() const { return shells_.empty(); }
  // True: every way from p to infinity meets a triangle. False: that is not known.
  bool hold(const Vec3& p) const;

 private:
  using Corners = std::array<Vec3, 3>;

  // The triangles by where they lie, seen along one direction.
  struct Shell {
    Vec3d lower, upper;
    Vec2d from, per_cell;  // of the grid: coordinate of its corner, size of a cell
    int cells = 1;         // along either side
    std::vector<uint32_t> first, of_cell;
    std::vector<Corners> triangles;

    explicit Shell(std::vector<Corners> all);
    bool holds(const Vec3& p) const;
    std::array<int, 2> cell_of(const Vec2d& at) const;
  };
  std::vector<Shell> shells_;  // the largest first
};

}  // namespace troffer
