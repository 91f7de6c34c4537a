#include "trace/closed_shells.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/polygon_list.h"
#include "trace/closed_surfaces.h"

namespace troffer {

namespace {

// Limits that keep rooms rather than the boxes in them: number of shells, grid cells per side, and
// triangles.
constexpr size_t most_shells = 64;
constexpr int most_cells = 512;
constexpr size_t most_triangles = 1 << 19;
// Crossings are counted along (slant, 1), a direction that no edge of a building has.
constexpr double slant_x = 0.37139067635410375, slant_y = 0.18490138027430116;
// Rounding bound of determinants of two and three coordinate differences of at most 1: some dozen
// roundings of 2^-53.
constexpr double rounding = 0x1p-44;

Vec2d along_slant(const Vec3d& p) {
  return {p.x - slant_x * p.z, p.y - slant_y * p.z};
}

double largest(const Vec3d& v) {
  return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
}

enum class Crossing { none, once, unknown };

// Crossing of a triangle by the ray from p.
Crossing crossing(const std::array<Vec3, 3>& triangle, const Vec3& p) {
  std::array<Vec3d, 3> d;
  std::array<Vec2d, 3> q;
  double size = 0;
  for (size_t i = 0; i < 3; ++i) {
    d[i] = Vec3d(triangle[i]) - Vec3d(p);
    q[i] = along_slant(d[i]);
    size = std::max(size, largest(d[i]));
  }
  bool has_left = false, has_right = false, is_sure = true;
  for (size_t i = 0; i < 3; ++i) {
    const Vec2d &a = q[i], &b = q[(i + 1) % 3];
    const double side = a.x * b.y - a.y * b.x;
    has_left = has_left || side > rounding * size * size;
    has_right = has_right || side < -rounding * size * size;
    is_sure = is_sure && std::abs(side) > rounding * size * size;
  }
  if (has_left && has_right) return Crossing::none;
  if (!is_sure) return Crossing::unknown;
  const Vec3d n = cross(d[1] - d[0], d[2] - d[0]);
  // the normal points up the slant if the corners run counterclockwise
  const double height = dot(n, d[0]) * (has_left ? 1 : -1);
  if (std::abs(height) <= rounding * size * size * size) return Crossing::unknown;
  return height > 0 ? Crossing::once : Crossing::none;
}

// Returns the opaque meshes of fewest triangles, up to most_triangles in total, in scene order.
// Walls have few triangles. Omitted meshes only make proofs fail.
std::vector<uint32_t> meshes_of_rooms(const Scene& scene, const PaneGlass* glass) {
  std::vector<uint32_t> meshes;
  for (uint32_t i = 0; i < scene.meshes.size(); ++i) {
    const Mesh& mesh = scene.meshes[i];
    if (!mesh.triangles.empty() && !scene.materials[mesh.material].is_alpha_masked &&
        !(glass != nullptr && glass->is_pane(mesh.material)))
      meshes.push_back(i);
  }
  std::stable_sort(meshes.begin(), meshes.end(), [&](uint32_t a, uint32_t b) {
    return scene.meshes[a].triangles.size() < scene.meshes[b].triangles.size();
  });
  size_t triangles = 0, n = 0;
  while (n < meshes.size() &&
         (triangles += scene.meshes[meshes[n]].triangles.size()) <= most_triangles)
    ++n;
  meshes.resize(n);
  std::sort(meshes.begin(), meshes.end());
  return meshes;
}

}  // namespace

ClosedShells::Shell::Shell(std::vector<Corners> all) : triangles(std::move(all)) {
  constexpr double inf = std::numeric_limits<double>::infinity();
  lower = Vec3d(triangles[0][0]);
  upper = lower;
  from = {inf, inf};
  Vec2d to{-inf, -inf};
  for (const Corners& t : triangles)
    for (const Vec3& c : t) {
      const Vec3d v(c);
      const Vec2d at = along_slant(v);
      lower = {std::min(lower.x, v.x), std::min(lower.y, v.y), std::min(lower.z, v.z)};
      upper = {std::max(upper.x, v.x), std::max(upper.y, v.y), std::max(upper.z, v.z)};
      from = {std::min(from.x, at.x), std::min(from.y, at.y)};
      to = {std::max(to.x, at.x), std::max(to.y, at.y)};
    }
  cells = std::clamp(int(std::sqrt(double(triangles.size()))), 1, most_cells);
  per_cell = {(to.x - from.x) / cells, (to.y - from.y) / cells};
  const auto n = size_t(cells) * size_t(cells);
  // one more cell on either side absorbs rounding
  const auto each_cell = [&](const Corners& t, const auto& visit) {
    std::array<int, 2> low{cells, cells}, high{0, 0};
    for (const Vec3& c : t) {
      const std::array<int, 2> at = cell_of(along_slant(Vec3d(c)));
      for (size_t k = 0; k < 2; ++k) {
        low[k] = std::min(low[k], std::max(at[k] - 1, 0));
        high[k] = std::max(high[k], std::min(at[k] + 1, cells - 1));
      }
    }
    for (int y = low[1]; y <= high[1]; ++y)
      for (int x = low[0]; x <= high[0]; ++x) visit(size_t(y) * size_t(cells) + size_t(x));
  };
  first.assign(n + 1, 0);
  for (const Corners& t : triangles) each_cell(t, [&](size_t cell) { ++first[cell + 1]; });
  for (size_t i = 0; i < n; ++i) first[i + 1] += first[i];
  of_cell.resize(first[n]);
  std::vector<uint32_t> next(first.begin(), first.end() - 1);
  for (uint32_t i = 0; i < triangles.size(); ++i)
    each_cell(triangles[i], [&](size_t cell) { of_cell[next[cell]++] = i; });
}

std::array<int, 2> ClosedShells::Shell::cell_of(const Vec2d& at) const {
  const auto number = [&](double offset, double size) {
    return size > 0 ? int(std::clamp(offset / size, 0.0, double(cells - 1))) : 0;
  };
  return {number(at.x - from.x, per_cell.x), number(at.y - from.y, per_cell.y)};
}

bool ClosedShells::Shell::holds(const Vec3& p) const {
  const Vec3d v(p);
  if (!(v.x > lower.x && v.y > lower.y && v.z > lower.z && v.x < upper.x && v.y < upper.y &&
        v.z < upper.z))
    return false;
  const std::array<int, 2> at = cell_of(along_slant(v));
  const size_t cell = size_t(at[1]) * size_t(cells) + size_t(at[0]);
  bool is_inside = false;
  for (uint32_t i = first[cell]; i < first[cell + 1]; ++i) {
    const Crossing c = crossing(triangles[of_cell[i]], p);
    if (c == Crossing::unknown) return false;
    if (c == Crossing::once) is_inside = !is_inside;
  }
  return is_inside;
}

ClosedShells::ClosedShells(const Scene& scene, const PaneGlass* glass) {
  std::vector<Vec3> positions;
  std::vector<std::array<uint32_t, 3>> triangles;
  for (const uint32_t i : meshes_of_rooms(scene, glass)) {
    const Mesh& mesh = scene.meshes[i];
    const auto base = uint32_t(positions.size());
    positions.insert(positions.end(), mesh.positions.begin(), mesh.positions.end());
    for (const Triangle& t : mesh.triangles)
      triangles.push_back({base + t[0], base + t[1], base + t[2]});
  }
  const std::vector<uint32_t> welded = weld(positions);
  for (auto& t : triangles) t = {welded[t[0]], welded[t[1]], welded[t[2]]};
  std::erase_if(triangles, [](const std::array<uint32_t, 3>& t) {
    return t[0] == t[1] || t[1] == t[2] || t[2] == t[0];
  });
  for (const std::vector<uint32_t>& surface : closed_surfaces(positions, triangles)) {
    std::vector<Corners> corners;
    for (const uint32_t t : surface)
      corners.push_back(
          {positions[triangles[t][0]], positions[triangles[t][1]], positions[triangles[t][2]]});
    shells_.emplace_back(std::move(corners));
  }
  std::stable_sort(shells_.begin(), shells_.end(), [](const Shell& a, const Shell& b) {
    return length_squared(a.upper - a.lower) > length_squared(b.upper - b.lower);
  });
  if (shells_.size() > most_shells)
    shells_.erase(shells_.begin() + std::ptrdiff_t(most_shells), shells_.end());
}

bool ClosedShells::hold(const Vec3& p) const {
  return std::any_of(shells_.begin(), shells_.end(), [&](const Shell& s) { return s.holds(p); });
}

}  // namespace troffer
