#include "transport/scene_glass.h"

#include "scene/mesh_in_world.h"
#include "transport/vertex.h"

namespace troffer {

namespace {

// Returns the share of light that passes a blended mesh at a hit.
float uncovered(const Scene& scene, const MeshInWorld& in_world, const Hit& hit) {
  const Mesh& mesh = in_world.mesh();
  Vec2 uv{0, 0};
  if (!mesh.uvs.empty()) {
    const Triangle t = in_world.triangle(hit.primitive);
    uv = mesh.uvs[t[0]] * (1 - hit.u - hit.v) + mesh.uvs[t[1]] * hit.u + mesh.uvs[t[2]] * hit.v;
  }
  return 1 - coverage(scene.textures, scene.materials[mesh.material], uv);
}

}  // namespace

Rgb SceneGlass::transmittance(const Ray& ray, const Hit& hit) const {
  if (is_mesh(scene_, hit.geometry)) {
    const MeshInWorld mesh = mesh_at(scene_, hit.geometry);
    if (scene_.materials[mesh.mesh().material].is_alpha_masked)
      return Rgb{uncovered(scene_, mesh, hit)};
  }
  Ray unit = ray;
  Hit at = hit;
  const float distance = length(ray.direction);
  unit.direction = ray.direction * (1 / distance);
  at.t *= distance;
  Vertex v;
  make_vertex(scene_, unit, at, v);
  if (!is_pane(v.surface.material)) return Rgb{1};  // a sphere or disk that is not a pane
  const Bsdf bsdf = make_bsdf(tables_, scene_, v.surface.material, v.surface.uv, v.is_front);
  return straight_transmittance(bsdf, v.wo);
}

}  // namespace troffer
