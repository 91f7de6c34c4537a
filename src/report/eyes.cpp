#include "report/eyes.h"

#include <algorithm>
#include <cmath>

#include "report/find_surfaces.h"

namespace troffer {

namespace {

template <class T, class Place>
void erase_covered(const PreparedScene& scene, const Vec3d& up, std::vector<T>& items,
                   const Place& place) {
  std::vector<Vec3d> points;
  for (const T& t : items) points.push_back(place(t));
  const std::vector<uint8_t> is_covered = covered_points(scene, points, up);
  size_t i = 0;
  std::erase_if(items, [&](const T&) { return is_covered[i++] != 0; });
}

// Returns the wanted place if it lies on the surface, else the nearest grid point. L-shaped rooms
// have no floor at the middle of some sides.
Vec3d place_near(const AssessedSurface& s, const SurfaceGrid& grid, const Vec2d& wanted) {
  const Vec3d place = s.place(wanted);
  if (lies_on(s, wanted)) return place;
  return std::min_element(grid.points.begin(), grid.points.end(),
                          [&](const GridPoint& a, const GridPoint& b) {
                            return length(a.position - place) < length(b.position - place);
                          })
      ->position;
}

void add_observers(const AssessedSurface& s, size_t number, const Vec3d& lift,
                   std::vector<PlacedObserver>& out) {
  const Vec2d middle{s.width / 2, s.height / 2};
  const SurfaceGrid grid = grid_of(s);
  const auto add = [&](const Vec2d& at, const Vec3d& direction) {
    out.push_back({number, {place_near(s, grid, at) + lift, direction}});
  };
  if (s.kind == SurfaceKind::floor || s.kind == SurfaceKind::work_plane) {
    const double x = std::min(s.border, middle.x), y = std::min(s.border, middle.y);
    add({x, middle.y}, s.along);
    add({s.width - x, middle.y}, -s.along);
    add({middle.x, y}, s.across);
    add({middle.x, s.height - y}, -s.across);
    return;
  }
  for (const Vec3d& d : {s.along, -s.along, s.across, -s.across}) add(middle, d);
}

}  // namespace

std::vector<EyePlace> eye_places(const PreparedScene& scene,
                                 const std::vector<AssessedSurface>& floors, const Vec3d& up,
                                 double height) {
  constexpr size_t most = 12;
  std::vector<EyePlace> places;
  for (size_t f = 0; f < floors.size(); ++f) {
    std::vector<EyePlace> all;
    for (const GridPoint& p : grid_of(floors[f]).points)
      all.push_back({f, p.position + up * height});
    erase_covered(scene, up, all, [](const EyePlace& p) { return p.position; });
    const size_t n = std::min(all.size(), most);
    // Rows lie side by side in the list: the middles of n equal parts spread over the floor.
    for (size_t i = 0; i < n; ++i) places.push_back(all[(2 * i + 1) * all.size() / (2 * n)]);
  }
  return places;
}

std::vector<PlacedObserver> observers_of(const PreparedScene& scene,
                                         const std::vector<AssessedSurface>& surfaces,
                                         const Vec3d& up, const std::vector<double>& eye_heights) {
  constexpr double level = 0.9397;  // cosine of 20 degrees, the steepest floor
  std::vector<PlacedObserver> observers;
  for (size_t i = 0; i < surfaces.size(); ++i) {
    const AssessedSurface& s = surfaces[i];
    if (dot(s.normal(), up) < level) continue;
    add_observers(s, i, up * (eye_heights[i] - s.above_floor), observers);
  }
  erase_covered(scene, up, observers, [](const PlacedObserver& o) { return o.observer.position; });
  return observers;
}

}  // namespace troffer
