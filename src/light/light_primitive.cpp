#include "light/light_primitive.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "base/frame.h"
#include "base/units.h"
#include "light/light.h"
#include "light/polygon.h"
#include "light/web.h"

namespace troffer {

namespace {

// Sets all fields that follow from a planar polygon's vertices. Returns false if it has no area.
bool set_polygon(LightPrimitive& p, std::span<const Vec3> vertices) {
  if (vertices.size() < 3) return false;
  const Vec3d vector = area_vector(vertices);
  const double area = length(vector);
  p.area = float(area);
  if (!(p.area > 0) || !std::isfinite(p.area)) return false;
  p.normal = vector / area;
  p.vertex_count = uint32_t(vertices.size());
  if (vertices.size() <= 4) std::copy(vertices.begin(), vertices.end(), p.vertices);
  p.centroid = Vec3(centroid(vertices, p.normal));
  for (const Vec3& v : vertices) {
    p.bounds.grow(v);
    p.radius = std::max(p.radius, length(v - p.centroid));
  }
  p.cone_axis = Vec3(p.normal);
  p.cos_cone = 1;
  if (vertices.size() == 3) {
    p.shape = PrimitiveShape::triangle;
  } else if (is_rectangle(vertices)) {
    p.shape = PrimitiveShape::rectangle;
    const Vec3d u = Vec3d(vertices[1]) - Vec3d(vertices[0]);
    const Vec3d v = Vec3d(vertices[3]) - Vec3d(vertices[0]);
    p.size_x = float(length(u));
    p.size_y = float(length(v));
    p.axis_x = Vec3(normalize(u));
    p.axis_y = Vec3(normalize(v));
  } else {
    p.shape = PrimitiveShape::polygon;
  }
  return true;
}

// Returns the mean emission over a triangle from one lookup at the centre of each of n² equal
// parts.
Rgb mean_over_triangle(const Scene& scene, const Light& e, const Vec2 (&uv)[3], int n) {
  const Vec2 a = uv[1] - uv[0], b = uv[2] - uv[0];
  Rgb sum;
  int count = 0;
  for (int i = 0; i < n; ++i) {
    for (int j = 0; i + j < n; ++j) {
      // One upright part, and the inverted part beside it.
      for (int half = 0; half < (i + j + 1 < n ? 2 : 1); ++half) {
        const float offset = half == 0 ? 1.0f / 3 : 2.0f / 3;
        const float b1 = (float(i) + offset) / float(n), b2 = (float(j) + offset) / float(n);
        sum += emitted_radiance(scene, e, true, uv[0] + a * b1 + b * b2);
        ++count;
      }
    }
  }
  return sum / float(count);
}

// Returns the mean emission from about one lookup per texel, up to 16². If all are dark, uses up to
// 128², because a light without power would never be sampled.
Rgb mean_over_triangle(const Scene& scene, const Light& e, const Vec2 (&uv)[3]) {
  const Vec2 a = uv[1] - uv[0], b = uv[2] - uv[0];
  const float uv_area = 0.5f * std::abs(a.x * b.y - a.y * b.x);
  const int32_t mask =
      e.is_alpha_masked ? scene.materials[scene.meshes[e.geometry].material].alpha.texture : -1;
  int least = 1, wanted = 1;
  for (const int32_t texture : {e.texture, mask}) {
    if (texture < 0) continue;
    const Texture& t = scene.textures[size_t(texture)];
    if (t.kind == TextureKind::constant) continue;
    least = std::max(least, t.kind == TextureKind::product ? 16 : 4);
    const float texels = uv_area * float(t.width) * float(t.height);
    if (t.kind == TextureKind::product || !std::isfinite(texels))
      wanted = 128;
    else
      wanted = std::max(wanted, int(std::sqrt(std::min(texels, 2e4f))) + 1);
  }
  const int n = std::clamp(wanted, least, 16);
  const Rgb mean = mean_over_triangle(scene, e, uv, n);
  if (!mean.is_black() || wanted <= n) return mean;
  return mean_over_triangle(scene, e, uv, std::min(wanted, 128));
}

}  // namespace

// Sets the mean radiance of a piece that emits by a photometric web: that of a diffuse piece with
// the same flux. The dependence on direction is in surface_light.h.
void LightPrimitives::set_web(const Scene& scene, const Light& e, LightPrimitive& p) {
  if (e.web == no_web) return;
  p.is_textured = true;
  const LightWeb& web = scene.webs[size_t(e.web)];
  if (web.faces.empty()) {  // a sphere's area is four times its cross-section
    p.mean_radiance = e.radiance * float(flux(web) / (pi * 4 * double(web.cross_section)));
    return;
  }
  std::unique_ptr<const WebSamples>& samples = web_samples_[size_t(e.web)];
  if (!samples) samples = std::make_unique<const WebSamples>(web);
  const Vec3 front(p.normal);
  const Vec3 n{dot(front, e.axes[0]), dot(front, e.axes[1]), dot(front, e.axes[2])};
  double exitance = samples->exitance(n);
  if (e.is_two_sided) exitance = (exitance + samples->exitance(-n)) / 2;
  p.mean_radiance = e.radiance * float(exitance / pi);
}

LightPrimitives::LightPrimitives(const Scene& scene)
    : disk_table_(scene.disks.size(), no_primitive),
      sphere_table_(scene.spheres.size(), no_primitive) {
  triangle_table_.resize(scene.meshes.size());
  web_samples_.resize(scene.webs.size());
  ranges_.reserve(scene.lights.size());
  Box scene_bounds;
  for (const Light& e : scene.lights)
    if (!has_surface(e.kind) && scene_bounds.is_empty()) scene_bounds = bounds(scene);
  for (uint32_t i = 0; i < scene.lights.size(); ++i) {
    const auto first = uint32_t(primitives_.size());
    if (emits(scene.lights[i])) {
      switch (scene.lights[i].kind) {
        case LightKind::polygon:
          add_polygon(scene, i);
          break;
        case LightKind::mesh:
          add_mesh(scene, i);
          break;
        case LightKind::disk:
          add_disk(scene, i);
          break;
        case LightKind::sphere:
          add_sphere(scene, i);
          break;
        case LightKind::point:
        case LightKind::spot:
        case LightKind::distant:
        case LightKind::environment:
        case LightKind::sky:
        case LightKind::sun:
          add_without_surface(scene, i, scene_bounds);
          break;
      }
    }
    ranges_.push_back({first, uint32_t(primitives_.size())});
  }
  web_samples_.clear();
}

int32_t LightPrimitives::append(LightPrimitive p, const Light& e) {
  p.is_two_sided = e.is_two_sided;
  p.power = float(pi) * p.area * luminance(p.mean_radiance) * (p.is_two_sided ? 2.0f : 1.0f);
  p.tree_power = p.power;
  primitives_.push_back(p);
  return int32_t(primitives_.size()) - 1;
}

void LightPrimitives::add_without_surface(const Scene& scene, uint32_t light,
                                          const Box& scene_bounds) {
  const Light& e = scene.lights[light];
  std::unique_ptr<const DirectionTable> directions = make_directions(scene, e);
  if (directions && !(directions->integral() > 0)) return;
  LightPrimitive p = make_piece(scene, e, scene_bounds, directions.get());
  if (directions) directions_.push_back(std::move(directions));
  if (std::unique_ptr<const Portal> portal = make_portal(scene, e, p)) {
    p.portal = portal.get();
    // Power that enters through the portal.
    p.power = p.tree_power = pi_f * float(portal->area()) * luminance(p.mean_radiance);
    portals_.push_back(std::move(portal));
  }
  p.light = light;
  if (p.is_infinite()) at_infinity_.push_back(uint32_t(primitives_.size()));
  primitives_.push_back(p);
}

void LightPrimitives::add_polygon(const Scene& scene, uint32_t light) {
  const Light& e = scene.lights[light];
  LightPrimitive p;
  p.light = light;
  p.mean_radiance = e.radiance;
  if (!set_polygon(p, e.polygon)) return;
  if (e.polygon.size() > 4) {
    vertices_.push_back(e.polygon);
    p.more_vertices = vertices_.back().data();  // stays valid when vertices_ grows
  }
  set_web(scene, e, p);
  const int32_t index = append(p, e);
  std::vector<int32_t>& table = triangle_table_[e.geometry];
  table.resize(scene.meshes[e.geometry].triangles.size(), no_primitive);
  for (const uint32_t t : e.triangles) table[t] = index;
}

void LightPrimitives::add_mesh(const Scene& scene, uint32_t light) {
  const Light& e = scene.lights[light];
  const Mesh& mesh = scene.meshes[e.geometry];
  std::vector<int32_t>& table = triangle_table_[e.geometry];
  table.resize(mesh.triangles.size(), no_primitive);
  for (const uint32_t t : e.triangles) {
    const Triangle& corners = mesh.triangles[t];
    LightPrimitive p;
    p.light = light;
    p.triangle = int32_t(t);
    p.mean_radiance = e.radiance;
    Vec3 positions[3];
    for (size_t i = 0; i < 3; ++i) {
      positions[i] = mesh.positions[corners[i]];
      if (!mesh.uvs.empty()) p.uvs[i] = mesh.uvs[corners[i]];
    }
    if (!set_polygon(p, positions)) continue;
    if (e.texture >= 0 || e.is_alpha_masked) {
      p.is_textured = true;
      p.mean_radiance = mean_over_triangle(scene, e, p.uvs);
    }
    set_web(scene, e, p);
    table[t] = append(p, e);
  }
}

void LightPrimitives::add_disk(const Scene& scene, uint32_t light) {
  const Light& e = scene.lights[light];
  const Disk& disk = scene.disks[e.geometry];
  LightPrimitive p;
  p.shape = PrimitiveShape::disk;
  p.light = light;
  p.mean_radiance = e.radiance;
  p.radius = disk.radius;
  p.area = pi_f * disk.radius * disk.radius;
  if (!(p.area > 0) || !std::isfinite(p.area)) return;
  p.centroid = disk.centre;
  p.normal = normalize(Vec3d(disk.normal));
  const Framed frame(p.normal);
  p.axis_x = Vec3(frame.tangent);
  p.axis_y = Vec3(frame.bitangent);
  Vec3 half;
  for (size_t a = 0; a < 3; ++a)
    half[a] = disk.radius * float(std::sqrt(std::max(0.0, 1 - sqr(p.normal[a]))));
  p.bounds.grow(disk.centre - half);
  p.bounds.grow(disk.centre + half);
  p.cone_axis = Vec3(p.normal);
  p.cos_cone = 1;
  set_web(scene, e, p);
  disk_table_[e.geometry] = append(p, e);
}

void LightPrimitives::add_sphere(const Scene& scene, uint32_t light) {
  const Light& e = scene.lights[light];
  const Sphere& sphere = scene.spheres[e.geometry];
  LightPrimitive p;
  p.shape = PrimitiveShape::sphere;
  p.light = light;
  p.mean_radiance = e.radiance;
  p.radius = sphere.radius;
  p.area = 4 * pi_f * sphere.radius * sphere.radius;
  if (!(p.area > 0) || !std::isfinite(p.area)) return;
  p.is_inside_out = sphere.is_inside_out;
  p.centroid = sphere.centre;
  p.bounds.grow(sphere.centre - Vec3{sphere.radius});
  p.bounds.grow(sphere.centre + Vec3{sphere.radius});
  set_web(scene, e, p);
  sphere_table_[e.geometry] = append(p, e);
}

}  // namespace troffer
