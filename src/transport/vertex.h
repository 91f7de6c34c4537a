// A vertex of a path: the surface hit, with frame and normals on the side from which the path
// comes. Also sensors, which are vertices without a hit. Used by all integrators. Positions are in
// world space, metres; normals are unit vectors.
#pragma once

#include "base/frame.h"
#include "bsdf/bsdf.h"
#include "trace/surface.h"

namespace troffer {

// Frames and normals are on the viewer's side.
struct Vertex {
  Surface surface;
  Frame frame;            // shading frame, z on the viewer's side
  Vec3 geometric_normal;  // on the viewer's side
  Vec3 wo;                // unit direction to the viewer, local frame
  bool is_front = true;   // the viewer is on the surface's front

  // True if the shading and the geometric normal agree on which side a direction lies, given in
  // world space and in the local frame. Otherwise light would leak through the surface.
  bool is_consistent(const Vec3& world, const Vec3& local) const {
    return dot(world, geometric_normal) * local.z > 0;
  }
};

// Turns everything about v.surface to the side from which a ray of this unit direction comes.
inline void face_viewer(Vertex& v, const Vec3& ray_direction) {
  const Vec3 towards_viewer = -ray_direction;
  v.is_front = dot(v.surface.geometric_normal, towards_viewer) >= 0;
  const float side = v.is_front ? 1.0f : -1.0f;
  v.geometric_normal = v.surface.geometric_normal * side;
  Vec3 n = v.surface.shading_normal * side;
  // Interpolated normals may face away from a viewer who sees the surface.
  if (dot(n, towards_viewer) <= 1e-4f) n = v.geometric_normal;
  v.frame = Frame(n);
  v.wo = v.frame.to_local(towards_viewer);
}

// Returns the vertex where a ray of unit direction meets a surface. The second form computes the
// surface from a hit and works in place, since vertices are large.
inline Vertex make_vertex(const Surface& surface, const Vec3& ray_direction) {
  Vertex v;
  v.surface = surface;
  face_viewer(v, ray_direction);
  return v;
}
inline void make_vertex(const Scene& scene, const Ray& ray, const Hit& hit, Vertex& v,
                        const RayCone& cone = {}) {
  surface_at(scene, ray, hit, v.surface, cone);
  face_viewer(v, ray.direction);
}

// Returns a sensor as a vertex that is seen along its normal.
inline Vertex make_sensor_vertex(const Vec3& position, const Vec3& normal, float offset) {
  Vertex v;
  v.surface.position = position;
  v.surface.offset = offset;
  v.surface.geometric_normal = v.surface.shading_normal = v.geometric_normal = normal;
  v.frame = Frame(normal);
  v.wo = {0, 0, 1};
  return v;
}
// Returns the BSDF of a sensor: Lambertian with reflectance pi, so that reflected radiance equals
// irradiance.
inline Bsdf sensor_bsdf() {
  Bsdf b;
  b.is_lambertian = b.has_separable = true;
  b.diffuse = Rgb{pi_f};
  return b;
}

}  // namespace troffer
