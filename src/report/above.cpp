#include "report/above.h"

#include <algorithm>
#include <limits>

#include "trace/surface.h"

namespace troffer {

Ray ray_from(const PreparedScene& scene, const Vec3d& point, const Vec3d& direction) {
  const Vec3 p(point - scene.scene.origin);
  const Vec3 reach = abs(p);
  Ray ray;
  ray.direction = Vec3(direction);
  ray.origin =
      p + ray.direction *
              std::max(1e-5f, 4 * ray_offset(std::max(reach.x, std::max(reach.y, reach.z))));
  return ray;
}

std::vector<Above> above(const PreparedScene& scene, const std::vector<Vec3d>& points,
                         const Vec3d& up) {
  std::vector<Ray> rays;
  for (const Vec3d& p : points) rays.push_back(ray_from(scene, p, up));
  std::vector<Hit> hits(rays.size());
  scene.tracer.closest(rays, hits);
  std::vector<Above> found(points.size());
  for (size_t i = 0; i < rays.size(); ++i) {
    found[i].height = std::numeric_limits<double>::infinity();
    if (!hits[i].is_valid()) continue;
    found[i].height = double(hits[i].t);
    const Surface s = surface_at(scene.scene, rays[i], hits[i]);
    found[i].is_within = dot(s.geometric_normal, rays[i].direction) > 0;
  }
  return found;
}

}  // namespace troffer
