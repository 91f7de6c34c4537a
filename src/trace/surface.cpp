#include "trace/surface.h"

#include <algorithm>

namespace troffer {

namespace {

float largest_coordinate(const Vec3& p) {
  return std::max(std::abs(p.x), std::max(std::abs(p.y), std::abs(p.z)));
}

// Tangent along increasing u, from the triangle's texture coordinates; false if they are singular.
bool tangent_from_uvs(const std::array<Vec3, 3>& p, const std::array<Vec2, 3>& uv, Vec3& tangent,
                      bool& is_mirrored) {
  const Vec2 d1 = uv[1] - uv[0], d2 = uv[2] - uv[0];
  const float det = d1.x * d2.y - d1.y * d2.x;
  if (det == 0 || !std::isfinite(det)) return false;
  tangent = ((p[1] - p[0]) * d2.y - (p[2] - p[0]) * d1.y) * (1 / det);
  is_mirrored = det < 0;
  const float l = length(tangent);
  if (!(l > 0) || !std::isfinite(l)) return false;
  tangent = tangent / l;
  return true;
}

// Normal map: tangent-space normal, x along u, y up the image (against v), z outwards (glTF).
Vec3 mapped_normal(const Scene& scene, const Material& m, const Surface& s,
                   const std::array<Vec3, 3>& p, const std::array<Vec2, 3>& uv) {
  Vec3 t;
  bool is_mirrored = false;
  if (!tangent_from_uvs(p, uv, t, is_mirrored)) return s.shading_normal;
  const Vec3 n = s.shading_normal;
  t = t - n * dot(n, t);
  const float l = length(t);
  if (!(l > 1e-6f)) return n;
  t = t / l;
  // The bitangent runs up the image: against v, or with it where the lookup flips v.
  const bool is_v_up = scene.textures[uint32_t(m.normal_texture)].uv_scale.y < 0;
  const Vec3 b = is_mirrored != is_v_up ? cross(n, t) : cross(t, n);
  const Rgb c = evaluate(scene.textures, uint32_t(m.normal_texture), s.uv).rgb;
  const Vec3 local{(2 * c.r - 1) * m.normal_scale, (2 * c.g - 1) * m.normal_scale, 2 * c.b - 1};
  const Vec3 mapped = t * local.x + b * local.y + n * local.z;
  const float ml = length(mapped);
  if (!(ml > 1e-6f) || dot(mapped, s.geometric_normal) <= 0) return n;
  return mapped / ml;
}

void triangle_surface(const Scene& scene, const Hit& hit, Surface& s) {
  const Mesh& mesh = scene.meshes[hit.geometry];
  const Triangle& t = mesh.triangles[hit.primitive];
  const std::array<Vec3, 3> p{mesh.positions[t[0]], mesh.positions[t[1]], mesh.positions[t[2]]};
  const float w = 1 - hit.u - hit.v;
  s.geometry = hit.geometry;
  s.primitive = hit.primitive;
  s.position = p[0] * w + p[1] * hit.u + p[2] * hit.v;
  s.geometric_normal = normalize(cross(p[1] - p[0], p[2] - p[0]));
  s.offset = ray_offset(
      std::max({largest_coordinate(p[0]), largest_coordinate(p[1]), largest_coordinate(p[2])}));
  s.material = mesh.material;
  s.light = mesh.lights.empty() ? no_light : mesh.lights[hit.primitive];
  s.shading_normal = s.geometric_normal;
  if (!mesh.normals.empty()) {
    const Vec3 n = mesh.normals[t[0]] * w + mesh.normals[t[1]] * hit.u + mesh.normals[t[2]] * hit.v;
    const float l = length(n);
    if (l > 1e-6f) s.shading_normal = n / (dot(n, s.geometric_normal) < 0 ? -l : l);
  }
  s.uv = {};
  if (!mesh.uvs.empty()) {
    const std::array<Vec2, 3> uv{mesh.uvs[t[0]], mesh.uvs[t[1]], mesh.uvs[t[2]]};
    s.uv = uv[0] * w + uv[1] * hit.u + uv[2] * hit.v;
    const Material& m = scene.materials[mesh.material];
    if (m.normal_texture >= 0) s.shading_normal = mapped_normal(scene, m, s, p, uv);
  }
}

void sphere_surface(const Scene& scene, const Ray& ray, const Hit& hit, Surface& s) {
  const Sphere& sphere = scene.spheres[hit.primitive];
  const Vec3 from_centre =
      normalize(ray.origin + ray.direction * hit.t - sphere.centre);  // re-projected: accurate
  s.geometry = hit.geometry;
  s.primitive = hit.primitive;
  s.position = sphere.centre + from_centre * sphere.radius;
  s.geometric_normal = sphere.is_inside_out ? -from_centre : from_centre;
  s.shading_normal = s.geometric_normal;
  s.uv = {};
  // Embree solves a quadratic: its t errs more than a triangle's.
  s.offset = 4 * ray_offset(largest_coordinate(sphere.centre) + sphere.radius);
  s.material = sphere.material;
  s.light = sphere.light;
}

void disk_surface(const Scene& scene, const Ray& ray, const Hit& hit, Surface& s) {
  const Disk& disk = scene.disks[hit.primitive];
  const Vec3 p = ray.origin + ray.direction * hit.t;
  s.geometry = hit.geometry;
  s.primitive = hit.primitive;
  s.position = p - disk.normal * dot(disk.normal, p - disk.centre);
  s.geometric_normal = s.shading_normal = disk.normal;
  s.uv = {};
  s.offset = ray_offset(largest_coordinate(disk.centre) + disk.radius);
  s.material = disk.material;
  s.light = disk.light;
}

}  // namespace

void surface_at(const Scene& scene, const Ray& ray, const Hit& hit, Surface& out) {
  if (hit.geometry < scene.meshes.size())
    triangle_surface(scene, hit, out);
  else if (hit.geometry == scene.meshes.size())
    sphere_surface(scene, ray, hit, out);
  else
    disk_surface(scene, ray, hit, out);
}

Surface surface_at(const Scene& scene, const Ray& ray, const Hit& hit) {
  Surface s;
  surface_at(scene, ray, hit, s);
  return s;
}

}  // namespace troffer
