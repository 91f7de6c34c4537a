#include "transport/connect.h"

#include <algorithm>
#include <cmath>

#include "scene/mesh_in_world.h"

namespace troffer {

Ray shadow_ray_to(const Surface& s, const Vec3& point, const Vec3& normal) {
  Ray ray;
  ray.origin = offset_origin(s, point - s.position);
  const float magnitude =
      std::max({std::abs(point.x), std::abs(point.y), std::abs(point.z), std::abs(s.position.x),
                std::abs(s.position.y), std::abs(s.position.z)});
  ray.direction = ended_before_light(point - ray.origin, normal, 2 * ray_offset(magnitude));
  ray.t_max = 1;
  return ray;
}

Ray shadow_ray_to(const Surface& surface, const LightSample& light) {
  if (!std::isinf(light.distance)) return shadow_ray_to(surface, light.point, light.normal);
  Ray ray;
  ray.origin = offset_origin(surface, light.wi);
  ray.direction = light.wi;
  return ray;
}

bool connect(const Vertex& v, const Bsdf& bsdf, const LightSample& s, LightConnection& out) {
  const Vec3 wi = v.frame.to_local(s.wi);
  if (!v.is_consistent(s.wi, wi)) return false;
  const BsdfValue value = evaluate_with_pdf(bsdf, v.wo, wi);
  if (value.f_cos.is_black()) return false;
  out.value = value.f_cos * s.radiance;
  if (out.value.is_black()) return false;
  out.pdf_light = s.pdf_solid_angle;
  out.pdf_bsdf = s.is_delta ? 0 : value.pdf;
  out.shadow_ray = shadow_ray_to(v.surface, s);
  return true;
}

float pdf_of_hit(const PreparedScene& scene, const LightPrimitive& light, const Vec3& from,
                 const Vec3& direction, const Vertex& v) {
  return pdf_solid_angle(scene.scene, light, from, direction, length(v.surface.position - from));
}

int32_t primitive_at(const PreparedScene& scene, const Surface& s) {
  const size_t meshes = scene.scene.meshes.size();
  if (is_instance(scene.scene, s.geometry)) return no_primitive;
  if (s.geometry < meshes) return scene.primitives.of_triangle(s.geometry, s.primitive);
  return s.geometry == meshes ? scene.primitives.of_sphere(s.primitive)
                              : scene.primitives.of_disk(s.primitive);
}

Rgb emission_at(const PreparedScene& scene, const Vertex& v) {
  const Surface& s = v.surface;
  if (s.light < 0) return Rgb{0};
  const Light& light = scene.scene.lights[size_t(s.light)];
  const Rgb mean = emitted_radiance(scene.scene, light, v.is_front, s.uv, v.frame.to_world(v.wo));
  // Rays pass a blended surface with probability 1 - share, so a hit is weighted by 1 / share.
  const float share = coverage(scene.scene, light, s.uv.uv);
  return share > 0 && share < 1 ? mean / share : mean;
}

}  // namespace troffer
