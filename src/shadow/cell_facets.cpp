#include "shadow/cell_facets.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace troffer {

namespace {

// Half-space normal · p > distance.
struct Beyond {
  Vec3d normal;
  double distance;
};

// Looks for a plane through a and b that touches the hull and has hull and cell on one side. Sets
// `out` to the half-space on its other side. Returns false if there is no such plane.
bool plane_through(const Vec3d& a, const Vec3d& b, const Vec3d& inside, const ReceiverHull& hull,
                   Beyond& out) {
  for (int r = 0; r < hull.count; ++r) {
    Vec3d n = cross(b - a, hull.corners[size_t(r)] - a);
    const double size = length(n);
    if (!(size > 0)) continue;
    n = n * ((dot(n, inside - a) > 0 ? -1 : 1) / size);
    double most = 0, magnitude = hull.magnitude;
    for (const double c : {a.x, a.y, a.z}) magnitude = std::max(magnitude, std::abs(c));
    for (int h = 0; h < hull.count; ++h) most = std::max(most, dot(n, hull.corners[size_t(h)] - a));
    if (most > 1e-9 * magnitude) continue;
    // The added distance exceeds the rounding errors of the hull and of the masks.
    out = {n, dot(n, a) + hull.slack + 4e-6 * magnitude};
    return true;
  }
  return false;
}

}  // namespace

void facets_for_cell(const ReceiverHull& hull, const FlatCell& cell,
                     std::span<const FacetToAdd> facets, std::vector<FacetToAdd>& out) {
  out.clear();
  const std::span<const Vec3d> corners = cell.all_corners();
  Vec3d middle;
  for (const Vec3d& c : corners) middle += c * (1.0 / double(corners.size()));
  std::array<Beyond, most_source_corners> planes;
  size_t count = 0;
  for (size_t i = 0; i < corners.size(); ++i)
    count +=
        plane_through(corners[i], corners[(i + 1) % corners.size()], middle, hull, planes[count])
            ? 1
            : 0;
  for (const FacetToAdd& f : facets) {
    const auto is_beyond = [&](const Beyond& p) {
      return std::all_of(f.quad.begin(), f.quad.end(),
                         [&](const Vec3& v) { return dot(p.normal, Vec3d(v)) > p.distance; });
    };
    if (std::none_of(planes.begin(), planes.begin() + std::ptrdiff_t(count), is_beyond))
      out.push_back(f);
  }
}

}  // namespace troffer
