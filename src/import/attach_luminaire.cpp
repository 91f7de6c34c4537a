#include "import/attach_luminaire.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/error.h"
#include "base/frame.h"
#include "base/units.h"
#include "import/emissive.h"
#include "import/mesh_clean.h"

namespace troffer {

namespace {

constexpr double flatness = 0.999;  // of the length of the sum of areas over their sum
constexpr float quarter_turn = pi_f / 2;
constexpr float least_uplight = 1e-3f;  // of the largest intensity

// C0 lies along the longer side of what the axis is normal to; without one anywhere.
std::array<Vec3, 3> axes_about(const Vec3d& axis, const Vec3d& along) {
  const Vec3d flat = along - axis * dot(along, axis);
  const Vec3d x = length(flat) > 1e-6 * length(along) ? normalize(flat) : Framed(axis).tangent;
  return {Vec3(x), Vec3(cross(axis, x)), Vec3(axis)};
}

// Files go up to the zenith whether or not light does. The radiosity halves what has two sides.
bool shines_upward(const LightWeb& web) {
  const size_t n = web.heights_rad.size();
  const float least =
      least_uplight * *std::max_element(web.intensities.begin(), web.intensities.end());
  for (size_t i = 0; i < web.intensities.size(); ++i)
    if (web.heights_rad[i % n] > quarter_turn + 1e-4f && web.intensities[i] > least) return true;
  return false;
}

struct Opening {
  std::vector<uint32_t> meshes;
  Vec3d area_vector;
  double area = 0;
  Vec3d longest_edge;
};

Opening opening_of(const Scene& scene, const std::string& node) {
  Opening o;
  for (uint32_t m = 0; m < scene.meshes.size(); ++m) {
    const Mesh& mesh = scene.meshes[m];
    bool is_named = mesh.name == node;
    for (const Light& e : scene.lights)
      is_named = is_named || (has_surface(e.kind) && e.name == node && e.geometry == m &&
                              (e.kind == LightKind::polygon || e.kind == LightKind::mesh));
    if (!is_named) continue;
    o.meshes.push_back(m);
    for (const Triangle& t : mesh.triangles) {
      const Vec3d a = area_vector(mesh, t) * 0.5;
      o.area_vector += a;
      o.area += length(a);
      for (size_t k = 0; k < 3; ++k) {
        const Vec3d edge = Vec3d(mesh.positions[t[(k + 1) % 3]]) - Vec3d(mesh.positions[t[k]]);
        if (length(edge) > length(o.longest_edge) * 1.0001) o.longest_edge = edge;
      }
    }
  }
  return o;
}

void attach_to_surfaces(Scene& scene, const std::string& node, const Luminaire& luminaire,
                        Rgb scale, int32_t web) {
  const Opening o = opening_of(scene, node);
  const bool is_known =
      !o.meshes.empty() || std::any_of(scene.lights.begin(), scene.lights.end(),
                                       [&](const Light& e) { return e.name == node; });
  if (!is_known) throw UsageError("--luminaire: nothing is named '" + node + "'");
  if (!(length(o.area_vector) >= flatness * o.area) || !(o.area > 0))
    throw UsageError("--luminaire: '" + node + "' is neither a flat surface nor a point");
  const auto axes = axes_about(normalize(o.area_vector), o.longest_edge);
  const bool is_two_sided = shines_upward(luminaire.web);
  for (const uint32_t m : o.meshes) {
    if (scene.meshes[m].lights.empty())
      add_mesh_lights(scene, m, {node, Rgb{1}, no_texture, is_two_sided});
    for (Light& e : scene.lights) {
      if (!has_surface(e.kind) || e.geometry != m ||
          (e.kind != LightKind::polygon && e.kind != LightKind::mesh))
        continue;
      e.web = web;
      e.axes = axes;
      e.texture = no_texture;
      e.is_two_sided = is_two_sided;
      e.radiance = scale * float(1 / o.area);
    }
  }
}

}  // namespace

void add_luminaire(Scene& scene, const std::string& name, const Luminaire& luminaire, int32_t web,
                   Rgb scale, const Vec3d& position, const Vec3d& down, const Vec3d& along) {
  const auto axes = axes_about(normalize(down), along);
  const double area = luminaire.width * luminaire.length;
  if (!(area > 1e-8) || luminaire.is_round) {
    Light e;
    e.name = name;
    e.kind = LightKind::point;
    e.position = Vec3(position);
    e.web = web;
    e.axes = axes;
    e.radiance = scale;
    scene.lights.push_back(std::move(e));
    return;
  }
  Mesh mesh;
  mesh.name = name;
  // counterclockwise seen from the nadir
  const Vec3d x = Vec3d(axes[0]) * (luminaire.length / 2),
              y = Vec3d(axes[1]) * (luminaire.width / 2);
  for (const Vec3d& corner : {-x - y, x - y, x + y, -x + y})
    mesh.positions.push_back(Vec3(position + corner));
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  mesh.material = uint32_t(scene.materials.size());
  Material black;
  black.base_color.value = Rgb{0};
  scene.materials.push_back(black);
  const auto first = scene.lights.size();
  scene.meshes.push_back(std::move(mesh));
  const bool is_two_sided = shines_upward(luminaire.web);
  add_mesh_lights(scene, uint32_t(scene.meshes.size()) - 1,
                  {name, Rgb{1}, no_texture, is_two_sided});
  for (size_t i = first; i < scene.lights.size(); ++i) {
    scene.lights[i].web = web;
    scene.lights[i].axes = axes;
    scene.lights[i].radiance = scale * float(1 / area);
  }
}

void attach_luminaire(Scene& scene, const std::string& node, const Luminaire& luminaire, Rgb scale,
                      const Vec3& down) {
  const auto web = int32_t(scene.webs.size());
  scene.webs.push_back(luminaire.web);
  bool is_point = false;
  for (Light& e : scene.lights) {
    if (e.name != node || (e.kind != LightKind::point && e.kind != LightKind::spot)) continue;
    const Vec3d axis = normalize(Vec3d(e.kind == LightKind::spot ? e.direction : down));
    e.kind = LightKind::point;
    e.web = web;
    e.axes = axes_about(axis, Framed(axis).tangent);
    e.radiance = scale;
    is_point = true;
  }
  if (!is_point) attach_to_surfaces(scene, node, luminaire, scale, web);
}

}  // namespace troffer
