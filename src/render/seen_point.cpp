#include "render/seen_point.h"

#include "render/camera.h"
#include "scene/mesh_in_world.h"
#include "trace/surface.h"

namespace troffer {

std::optional<SeenPoint> point_seen(const PreparedScene& scene, const Camera& camera, int width,
                                    int height, const Vec2& raster) {
  const ViewingCamera viewing(camera, width, height);
  const Ray ray = viewing.ray(raster, {0.5f, 0.5f});
  Hit hit;
  scene.tracer.closest({&ray, 1}, {&hit, 1}, Coherence::none, Meeting::no_panes);
  if (!hit.is_valid()) return std::nullopt;
  const Surface s = surface_at(scene.scene, ray, hit);
  SeenPoint seen;
  seen.point.position = Vec3d(s.position) + scene.scene.origin;
  seen.point.normal =
      dot(s.geometric_normal, ray.direction) > 0 ? -s.geometric_normal : s.geometric_normal;
  if (is_mesh(scene.scene, hit.geometry)) seen.name = mesh_at(scene.scene, hit.geometry).name();
  return seen;
}

}  // namespace troffer
