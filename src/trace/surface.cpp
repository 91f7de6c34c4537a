#include "trace/surface.h"

#include <algorithm>
#include <cmath>

#include "scene/mesh_in_world.h"

namespace troffer {

// References: [1] Akenine-Möller et al., "Texture Level of Detail Strategies for Real-Time Ray
//   Tracing", Ray Tracing Gems, 2019. [2] Mikkelsen, "Bump Mapping Unparametrized Surfaces on the
//   GPU", JGT 15(1), 2010.

namespace {

float largest_coordinate(const Vec3& p) {
  return std::max(std::abs(p.x), std::max(std::abs(p.y), std::abs(p.z)));
}

// Computes the unit tangent along increasing u. Returns false if the texture coordinates are
// singular.
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

// Texture coordinates of the corners, in both sets; a texture uses one of them.
using CornerUvs = std::array<Vec2, 3>;
struct UvSets {
  CornerUvs first, second;

  const CornerUvs& of(const Scene& scene, int32_t texture) const {
    return scene.textures[uint32_t(texture)].mapping == TextureMapping::second_uv ? second : first;
  }
};

// Computes the unit tangent along increasing u, orthogonal to n. Returns false if there is none.
bool tangent_about(const Vec3& n, const std::array<Vec3, 3>& p, const CornerUvs& uv, Vec3& t,
                   bool& is_mirrored) {
  if (!tangent_from_uvs(p, uv, t, is_mirrored)) return false;
  t = t - n * dot(n, t);
  const float l = length(t);
  if (!(l > 1e-6f)) return false;
  t = t / l;
  return true;
}

// Returns the shading normal of a tangent-space normal map: x along u, y up the image (against v),
// z outwards (glTF).
Vec3 mapped_normal(const Scene& scene, int32_t texture, float scale, const Surface& s,
                   const std::array<Vec3, 3>& p, const CornerUvs& uv) {
  Vec3 t;
  bool is_mirrored = false;
  const Vec3 n = s.shading_normal;
  if (!tangent_about(n, p, uv, t, is_mirrored)) return n;
  // The bitangent runs up the image: against v, or along v if the lookup flips it.
  const bool is_v_up = scene.textures[uint32_t(texture)].uv_scale.y < 0;
  const Vec3 b = is_mirrored != is_v_up ? cross(n, t) : cross(t, n);
  const Rgb c = evaluate(scene.textures, uint32_t(texture), s.uv).rgb;
  const Vec3 local{(2 * c.r - 1) * scale, (2 * c.g - 1) * scale, 2 * c.b - 1};
  const Vec3 mapped = t * local.x + b * local.y + n * local.z;
  const float ml = length(mapped);
  if (!(ml > 1e-6f) || dot(mapped, s.geometric_normal) <= 0) return n;
  return mapped / ml;
}

// Derivatives of positions by texture coordinates within a triangle.
struct TriangleUvs {
  Vec3 along_u, along_v;  // metres per unit
  bool is_fine = false;

  TriangleUvs(const std::array<Vec3, 3>& p, const std::array<Vec2, 3>& uv) {
    const Vec2 d1 = uv[1] - uv[0], d2 = uv[2] - uv[0];
    const float det = d1.x * d2.y - d1.y * d2.x;
    if (det == 0 || !std::isfinite(1 / det)) return;
    const Vec3 e1 = p[1] - p[0], e2 = p[2] - p[0];
    along_u = (e1 * d2.y - e2 * d1.y) * (1 / det);
    along_v = (e2 * d1.x - e1 * d2.x) * (1 / det);
    is_fine = length_squared(cross(along_u, along_v)) > 0;
  }
  // Returns the change of (u,v) along a vector in the plane.
  Vec2 over(const Vec3& way) const {
    const float uu = dot(along_u, along_u), uv = dot(along_u, along_v), vv = dot(along_v, along_v);
    const float a = dot(way, along_u), b = dot(way, along_v), inverse = 1 / (uu * vv - uv * uv);
    return Vec2{vv * a - uv * b, uu * b - uv * a} * inverse;
  }
};

// Sets the footprint of a cone in the surface [1]: its width across, and longer along its
// direction, by at most the factor `most`.
void set_footprint(const TriangleUvs& uvs, const Vec3& normal, const Vec3& direction, float width,
                   Vec2& axis_a, Vec2& axis_b) {
  constexpr float most = 64;
  const float cosine = dot(direction, normal);
  const Vec3 flat = direction - normal * cosine;
  const float l = length(flat);
  const Vec3 along = l > 1e-4f ? flat / l : Frame(normal).tangent;
  const float longer = std::min(1 / std::max(std::abs(cosine), 1e-6f), most);
  axis_a = uvs.over(along * (width * longer));
  axis_b = uvs.over(cross(normal, along) * width);
  if (!std::isfinite(axis_a.x + axis_a.y + axis_b.x + axis_b.y)) axis_a = axis_b = {};
}

// Returns the shading normal of a bump map [2]. The gradient of the height comes from differences
// over the footprint, or over a texel if that is larger.
Vec3 bumped_normal(const Scene& scene, const Material& m, const TriangleUvs& uvs,
                   const Surface& s) {
  const auto height = [&](const Vec2& d) {
    TexturePlace at = s.uv;
    at.uv = at.uv + d;
    at.position = at.position + uvs.along_u * d.x + uvs.along_v * d.y;
    return evaluate(scene.textures, m.bump, at);
  };
  const Vec2 texel = texel_step(scene.textures, uint32_t(m.bump.texture));
  const float wide = std::max(std::abs(s.uv.axis_a.x), std::abs(s.uv.axis_b.x)),
              high = std::max(std::abs(s.uv.axis_a.y), std::abs(s.uv.axis_b.y));
  const float du = 0.5f * std::max(wide, texel.x), dv = 0.5f * std::max(high, texel.y);
  const float by_u = (height({du, 0}) - height({-du, 0})) / (2 * du),
              by_v = (height({0, dv}) - height({0, -dv})) / (2 * dv);
  const Vec3 n = s.shading_normal, area = cross(uvs.along_u, uvs.along_v);
  const float side = dot(area, n) < 0 ? -1.0f : 1.0f;
  const Vec3 gradient =
      (cross(uvs.along_v, n) * by_u + cross(n, uvs.along_u) * by_v) * (side / length(area));
  const Vec3 bumped = n - gradient;
  const float l = length(bumped);
  if (!(l > 1e-6f) || !std::isfinite(l) || dot(bumped, s.geometric_normal) <= 0) return n;
  return bumped / l;
}

// Returns the direction of the grain of anisotropic gloss: increasing u, rotated by the material
// and its texture.
Vec2 grain_of(const Scene& scene, const Material& m, const Surface& s, const std::array<Vec3, 3>& p,
              const UvSets& uvs) {
  const int32_t texture = m.anisotropy.texture;
  Vec3 t;
  bool is_mirrored = false;
  const Vec3 n = s.shading_normal;
  if (!tangent_about(n, p, texture < 0 ? uvs.first : uvs.of(scene, texture), t, is_mirrored))
    return {1, 0};
  const bool is_v_up = texture >= 0 && scene.textures[uint32_t(texture)].uv_scale.y < 0;
  const Vec3 b = is_mirrored != is_v_up ? cross(n, t) : cross(t, n);
  Vec2 way{std::cos(m.anisotropy_rotation_rad), std::sin(m.anisotropy_rotation_rad)};
  if (texture >= 0) {
    const Rgb c = evaluate(scene.textures, uint32_t(texture), s.uv).rgb;
    const Vec2 d{2 * c.r - 1, 2 * c.g - 1};
    way = {way.x * d.x - way.y * d.y, way.y * d.x + way.x * d.y};
  }
  const Vec3 grain = Frame(n).to_local(t * way.x + b * way.y);
  const float l = std::sqrt(grain.x * grain.x + grain.y * grain.y);
  return l > 1e-6f ? Vec2{grain.x / l, grain.y / l} : Vec2{1, 0};
}

// True if lookups at the surface need more than (u,v), for its material or its light.
bool is_textured_at_all(const Scene& scene, const Surface& s) {
  const Material& m = scene.materials[s.material];
  return m.normal_texture >= 0 || m.bump.texture >= 0 || m.anisotropy.value > 0 ||
         has_own_coat_normal(m) || has_textured_input(m) ||
         (s.light >= 0 && scene.lights[size_t(s.light)].texture >= 0);
}

// Applies normal and bump maps, and sets the data for later texture lookups.
void set_textured(const Scene& scene, const Ray& ray, const Hit& hit, const RayCone& cone,
                  const std::array<Vec3, 3>& p, const UvSets& uv, bool has_second_uv, Surface& s) {
  if (!is_textured_at_all(scene, s)) return;
  const Material& m = scene.materials[s.material];
  const TriangleUvs uvs(p, uv.first);
  s.uv.position = s.position;
  s.uv.width = cone.width + cone.spread * hit.t;
  if (s.uv.width > 0 && uvs.is_fine)
    set_footprint(uvs, s.geometric_normal, ray.direction, s.uv.width, s.uv.axis_a, s.uv.axis_b);
  if (s.uv.width > 0 && has_second_uv) {
    const TriangleUvs second(p, uv.second);
    if (second.is_fine)
      set_footprint(second, s.geometric_normal, ray.direction, s.uv.width, s.uv.axis_2a,
                    s.uv.axis_2b);
  }
  Vec3 coat_normal = s.shading_normal;
  if (m.coat_normal_texture >= 0)
    coat_normal = mapped_normal(scene, m.coat_normal_texture, m.coat_normal_scale, s, p,
                                uv.of(scene, m.coat_normal_texture));
  if (m.normal_texture >= 0)
    s.shading_normal = mapped_normal(scene, m.normal_texture, m.normal_scale, s, p,
                                     uv.of(scene, m.normal_texture));
  if (m.bump.texture >= 0 && uvs.is_fine) s.shading_normal = bumped_normal(scene, m, uvs, s);
  if (m.anisotropy.value > 0) s.uv.grain = grain_of(scene, m, s, p, uv);
  if (has_own_coat_normal(m)) {
    const Vec3 local = Frame(s.shading_normal).to_local(coat_normal);
    s.uv.coat_normal = {local.x, local.y};
  }
}

// Sets position and cone width of shapes without texture coordinates, for textures in space.
void set_place(const RayCone& cone, const Hit& hit, Surface& s) {
  s.uv = {};
  s.uv.position = s.position;
  s.uv.width = cone.width + cone.spread * hit.t;
}

// A triangle in world space, with vertices in the order that shows the front.
struct TriangleHit {
  const Mesh& mesh;
  Triangle vertices;
  std::array<Vec3, 3> p;
};

void set_shading_normal(const std::array<Vec3, 3>& normals, const Hit& hit, Surface& s) {
  const Vec3 n = normals[0] * (1 - hit.u - hit.v) + normals[1] * hit.u + normals[2] * hit.v;
  const float l = length(n);
  if (l > 1e-6f) s.shading_normal = n / (dot(n, s.geometric_normal) < 0 ? -l : l);
}

void set_place_and_normal(const TriangleHit& t, const Hit& hit, Surface& s) {
  const std::array<Vec3, 3>& p = t.p;
  s.geometry = hit.geometry;
  s.primitive = hit.primitive;
  s.position = p[0] * (1 - hit.u - hit.v) + p[1] * hit.u + p[2] * hit.v;
  s.geometric_normal = normalize(cross(p[1] - p[0], p[2] - p[0]));
  s.material = t.mesh.material;
  s.shading_normal = s.geometric_normal;
}

void set_look(const Scene& scene, const Ray& ray, const TriangleHit& triangle, const Hit& hit,
              const RayCone& cone, Surface& s) {
  const Mesh& mesh = triangle.mesh;
  const Triangle& t = triangle.vertices;
  const float w = 1 - hit.u - hit.v;
  s.uv = {};
  if (!mesh.uvs.empty()) {
    UvSets uv{{mesh.uvs[t[0]], mesh.uvs[t[1]], mesh.uvs[t[2]]}, {}};
    s.uv.uv = uv.first[0] * w + uv.first[1] * hit.u + uv.first[2] * hit.v;
    if (!mesh.uvs_2.empty()) {
      uv.second = {mesh.uvs_2[t[0]], mesh.uvs_2[t[1]], mesh.uvs_2[t[2]]};
      s.uv.uv_2 = uv.second[0] * w + uv.second[1] * hit.u + uv.second[2] * hit.v;
    }
    set_textured(scene, ray, hit, cone, triangle.p, uv, !mesh.uvs_2.empty(), s);
  } else if (is_textured_at_all(scene, s)) {
    set_place(cone, hit, s);
  }
}

void triangle_surface(const Scene& scene, const Ray& ray, const Hit& hit, const RayCone& cone,
                      Surface& s) {
  const Mesh& mesh = scene.meshes[hit.geometry];
  const Triangle& t = mesh.triangles[hit.primitive];
  const TriangleHit triangle{
      mesh, t, {mesh.positions[t[0]], mesh.positions[t[1]], mesh.positions[t[2]]}};
  set_place_and_normal(triangle, hit, s);
  s.offset =
      ray_offset(std::max({largest_coordinate(triangle.p[0]), largest_coordinate(triangle.p[1]),
                           largest_coordinate(triangle.p[2])}));
  s.light = mesh.lights.empty() ? no_light : mesh.lights[hit.primitive];
  if (!mesh.normals.empty())
    set_shading_normal({mesh.normals[t[0]], mesh.normals[t[1]], mesh.normals[t[2]]}, hit, s);
  set_look(scene, ray, triangle, hit, cone, s);
}

void instance_surface(const Scene& scene, const Ray& ray, const Hit& hit, const RayCone& cone,
                      Surface& s) {
  const MeshInWorld mesh = mesh_at(scene, hit.geometry);
  const Triangle t = mesh.triangle(hit.primitive);
  const TriangleHit triangle{mesh.mesh(), t, mesh.corners(hit.primitive)};
  set_place_and_normal(triangle, hit, s);
  s.offset = ray_offset(mesh.instance()->reach);
  s.light = no_light;
  if (!mesh.mesh().normals.empty())
    set_shading_normal({mesh.normal(t[0]), mesh.normal(t[1]), mesh.normal(t[2])}, hit, s);
  set_look(scene, ray, triangle, hit, cone, s);
}

void sphere_surface(const Scene& scene, const Ray& ray, const Hit& hit, const RayCone& cone,
                    Surface& s) {
  const Sphere& sphere = scene.spheres[hit.primitive];
  // Projected again, for accuracy.
  const Vec3 from_centre = normalize(ray.origin + ray.direction * hit.t - sphere.centre);
  s.geometry = hit.geometry;
  s.primitive = hit.primitive;
  s.position = sphere.centre + from_centre * sphere.radius;
  s.geometric_normal = sphere.is_inside_out ? -from_centre : from_centre;
  s.shading_normal = s.geometric_normal;
  set_place(cone, hit, s);
  // Embree solves a quadratic for spheres, so t is less accurate than for triangles.
  s.offset = 4 * ray_offset(largest_coordinate(sphere.centre) + sphere.radius);
  s.material = sphere.material;
  s.light = sphere.light;
}

void disk_surface(const Scene& scene, const Ray& ray, const Hit& hit, const RayCone& cone,
                  Surface& s) {
  const Disk& disk = scene.disks[hit.primitive];
  const Vec3 p = ray.origin + ray.direction * hit.t;
  s.geometry = hit.geometry;
  s.primitive = hit.primitive;
  s.position = p - disk.normal * dot(disk.normal, p - disk.centre);
  s.geometric_normal = s.shading_normal = disk.normal;
  set_place(cone, hit, s);
  s.offset = ray_offset(largest_coordinate(disk.centre) + disk.radius);
  s.material = disk.material;
  s.light = disk.light;
}

// Sets the direction of up of an angular material. It is arbitrary where the surface is level.
void set_up(const Scene& scene, Surface& s) {
  const Material& m = scene.materials[s.material];
  if (m.kind != MaterialKind::angular) return;
  const Vec3 up = Frame(s.shading_normal).to_local(m.angular_up);
  const float l = std::sqrt(up.x * up.x + up.y * up.y);
  s.uv.grain = l > 1e-6f * length(m.angular_up) ? Vec2{up.x / l, up.y / l} : Vec2{0, 1};
}

}  // namespace

void surface_at(const Scene& scene, const Ray& ray, const Hit& hit, Surface& out,
                const RayCone& cone) {
  if (hit.geometry < scene.meshes.size())
    triangle_surface(scene, ray, hit, cone, out);
  else if (is_instance(scene, hit.geometry))
    instance_surface(scene, ray, hit, cone, out);
  else if (hit.geometry == scene.meshes.size())
    sphere_surface(scene, ray, hit, cone, out);
  else
    disk_surface(scene, ray, hit, cone, out);
  set_up(scene, out);
}

Surface surface_at(const Scene& scene, const Ray& ray, const Hit& hit) {
  Surface s;
  surface_at(scene, ray, hit, s);
  return s;
}

}  // namespace troffer
