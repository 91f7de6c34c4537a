#include "integrate/scene_glass.h"

#include "integrate/vertex.h"

namespace troffer {

Rgb SceneGlass::transmittance(const Ray& ray, const Hit& hit) const {
  Ray unit = ray;
  Hit at = hit;
  const float distance = length(ray.direction);
  unit.direction = ray.direction * (1 / distance);
  at.t *= distance;
  Vertex v;
  make_vertex(scene_, unit, at, v);
  if (!is_pane(v.surface.material)) return Rgb{1};  // a sphere or disk beside panes
  const Bsdf bsdf = make_bsdf(tables_, scene_, v.surface.material, v.surface.uv, v.is_front);
  return straight_transmittance(bsdf, v.wo.z);
}

}  // namespace troffer
