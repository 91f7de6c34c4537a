#include "view/measuring_grid.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "view/measuring_queue.h"

namespace troffer {

namespace {

// Returns a unit direction in the plane: level if the plane is steep, along a world axis if it is
// flat.
Vec3d side_of(const Vec3& normal, const Vec3& up) {
  const Vec3 level = cross(up, normal);
  constexpr float nearly_flat = 0.1f;
  if (length(level) > nearly_flat) return Vec3d(normalize(level));
  const Vec3 axis = std::abs(normal.x) < 0.5f ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
  return Vec3d(normalize(axis - normal * dot(axis, normal)));
}

}  // namespace

MeasuringGrid grid_between(const MeasuringPoint& first, const Vec3d& second, const Vec3& up,
                           int along) {
  const Vec3 normal = normalize(first.normal);
  const Vec3d u = side_of(normal, up), v = cross(Vec3d(normal), u);
  const Vec3d diagonal = second - first.position;
  const double a = dot(diagonal, u), b = dot(diagonal, v);
  MeasuringGrid grid;
  grid.width = std::abs(a);
  grid.depth = std::abs(b);
  const double longer = std::max(grid.width, grid.depth);
  if (!(std::min(grid.width, grid.depth) > 1e-3 * longer) || !std::isfinite(longer))
    throw UsageError("a grid needs two opposite corners of a rectangle");
  if (along < 1 || along > 1000) throw UsageError("a grid must have 1 to 1000 fields per side");
  const auto fields = [&](double side) {
    return std::max(1, int(std::lround(along * side / longer)));
  };
  grid.columns = fields(grid.width);
  grid.rows = fields(grid.depth);
  if (size_t(grid.columns) * size_t(grid.rows) > most_measuring_points)
    throw UsageError("the grid has more points than can be measured at a time");
  for (int j = 0; j < grid.rows; ++j)
    for (int i = 0; i < grid.columns; ++i)
      grid.points.push_back(
          {first.position + u * (a * (i + 0.5) / grid.columns) + v * (b * (j + 0.5) / grid.rows),
           normal});
  return grid;
}

}  // namespace troffer
