#include "scene/portal_corners.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/units.h"

namespace troffer {

namespace {

constexpr double tolerance = 1e-3;
// Triangles whose edges are tried as side directions; trying all would take quadratic time.
constexpr size_t most_looked_at = 256;

std::array<Vec3d, 3> corners_of(const Mesh& mesh, const Triangle& t) {
  return {Vec3d(mesh.positions[t[0]]), Vec3d(mesh.positions[t[1]]), Vec3d(mesh.positions[t[2]])};
}

}  // namespace

bool is_rectangle(std::span<const Vec3d> p) {
  if (p.size() != 4) return false;
  const Vec3d a = p[1] - p[0], b = p[2] - p[1], c = p[3] - p[2], d = p[0] - p[3];
  const double size = length(a) + length(b);
  if (!is_finite(a) || !is_finite(b) || !is_finite(c) || !is_finite(d) || !std::isfinite(size))
    return false;
  return length(a + c) < tolerance * size && length(a) > 1e-6 * size && length(b) > 1e-6 * size &&
         std::abs(dot(a, b)) < tolerance * length(a) * length(b) && size > 1e-9;
}

std::optional<std::vector<Vec3>> rectangle_of_meshes(const Scene& scene, const std::string& name) {
  Vec3d area, any;
  double sum = 0;
  const auto for_each = [&](const auto& visit) {
    for (const Mesh& mesh : scene.meshes)
      if (mesh.name == name)
        for (const Triangle& t : mesh.triangles) visit(corners_of(mesh, t));
  };
  for_each([&](const std::array<Vec3d, 3>& c) {
    const Vec3d own = cross(c[1] - c[0], c[2] - c[0]) * 0.5;
    area += own;
    sum += length(own);
    any = c[0];
  });
  if (!(sum > 0) || !(length(area) > (1 - tolerance) * sum)) return std::nullopt;
  const Vec3d n = normalize(area);
  // One edge runs along a side: the one with the smallest bounds along it.
  double least = INFINITY;
  std::vector<Vec3> best;
  size_t looked_at = 0;
  for_each([&](const std::array<Vec3d, 3>& c) {
    if (looked_at++ >= most_looked_at) return;
    for (size_t k = 0; k < 3; ++k) {
      const Vec3d edge = c[(k + 1) % 3] - c[k];
      if (!(length(edge) > 0)) continue;
      const Vec3d u = normalize(edge), v = cross(n, u);
      std::array<double, 2> low{INFINITY, INFINITY}, high{-INFINITY, -INFINITY};
      double off = 0;
      for_each([&](const std::array<Vec3d, 3>& other) {
        for (const Vec3d& p : other) {
          const std::array<double, 2> at{dot(p - any, u), dot(p - any, v)};
          off = std::max(off, std::abs(dot(p - any, n)));
          for (size_t a = 0; a < 2; ++a) {
            low[a] = std::min(low[a], at[a]);
            high[a] = std::max(high[a], at[a]);
          }
        }
      });
      const double bounds = (high[0] - low[0]) * (high[1] - low[1]);
      if (!(bounds < least) || !(sqr(off) < sqr(tolerance) * bounds)) continue;
      least = bounds;
      const auto at = [&](double x, double y) { return Vec3(any + u * x + v * y); };
      best = {at(low[0], low[1]), at(high[0], low[1]), at(high[0], high[1]), at(low[0], high[1])};
    }
  });
  if (best.empty() || !(std::abs(least - sum) < 4 * tolerance * sum)) return std::nullopt;
  return best;
}

}  // namespace troffer
