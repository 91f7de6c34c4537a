#include "scene/orientation.h"

namespace troffer {

Vec3 guess_up(const Scene& scene) {
  const Box box = bounds(scene);
  if (scene.is_photometric || box.is_empty()) return {0, 1, 0};
  const Vec3 e = box.extent();
  return e.z < e.y ? Vec3{0, 0, 1} : Vec3{0, 1, 0};
}

bool is_mirrored(const Scene& scene) {
  if (scene.cameras.empty()) return false;
  const Camera& c = scene.cameras.front();
  return dot(cross(c.forward, c.up), c.right) < 0;
}

}  // namespace troffer
