// A path's vertex: the surface hit, seen from where the path comes from.
#pragma once

#include "base/frame.h"
#include "bsdf/bsdf.h"
#include "trace/surface.h"

namespace troffer {

// Frames and normals are turned to the viewer's side.
struct Vertex {
  Surface surface;
  Frame frame;            // shading frame, z on the viewer's side
  Vec3 geometric_normal;  // on the viewer's side
  Vec3 wo;                // local, towards the viewer
  bool is_front = true;   // the viewer is on the surface's front

  // False where shading and geometric normal disagree on which side a direction (in world space and
  // in the local frame) lies: such light would leak through the surface.
  bool is_consistent(const Vec3& world, const Vec3& local) const {
    return dot(world, geometric_normal) * local.z > 0;
  }
};

// The vertex where `ray` (unit direction) meets the surface.
inline Vertex make_vertex(const Surface& surface, const Vec3& ray_direction) {
  Vertex v;
  v.surface = surface;
  const Vec3 towards_viewer = -ray_direction;
  v.is_front = dot(surface.geometric_normal, towards_viewer) >= 0;
  v.geometric_normal = v.is_front ? surface.geometric_normal : -surface.geometric_normal;
  Vec3 n = v.is_front ? surface.shading_normal : -surface.shading_normal;
  // Interpolated normals may face away from a viewer who sees the surface.
  if (dot(n, towards_viewer) <= 1e-4f) n = v.geometric_normal;
  v.frame = Frame(n);
  v.wo = v.frame.to_local(towards_viewer);
  return v;
}

// A point whose irradiance is asked for, as a vertex seen from straight above …
inline Vertex make_sensor_vertex(const Vec3& position, const Vec3& normal, float offset) {
  Vertex v;
  v.surface.position = position;
  v.surface.offset = offset;
  v.surface.geometric_normal = v.surface.shading_normal = v.geometric_normal = normal;
  v.frame = Frame(normal);
  v.wo = {0, 0, 1};
  return v;
}
// … and its surface: Lambertian of reflectance pi, so that what it sends on is the irradiance.
inline Bsdf sensor_bsdf() {
  Bsdf b;
  b.is_lambertian = b.has_separable = true;
  b.diffuse = Rgb{pi_f};
  return b;
}

}  // namespace troffer
