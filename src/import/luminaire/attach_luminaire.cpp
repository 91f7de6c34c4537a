#include "import/luminaire/attach_luminaire.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/error.h"
#include "base/frame.h"
#include "base/units.h"
#include "import/emissive.h"
#include "import/mesh_clean.h"
#include "scene/mesh_in_world.h"
#include "scene/names.h"

namespace troffer {

namespace {

constexpr double least_flatness = 0.999;  // length of the summed area vectors over the summed
                                          // areas; 1: flat

using Axes = std::array<Vec3, 3>;

// Returns the axes C0, C90 and nadir. C0 is the part of `along` perpendicular to the axis, or
// arbitrary if there is none. C90 is counterclockwise from C0, seen from above.
Axes axes_about(const Vec3d& axis, const Vec3d& along) {
  const Vec3d flat = along - axis * dot(along, axis);
  const Vec3d x = length(flat) > 1e-6 * length(along) ? normalize(flat) : Framed(axis).tangent;
  return {Vec3(x), Vec3(cross(x, axis)), Vec3(axis)};
}

// Returns the axes for a surface whose longest edge is `longest`: the longer side of the
// luminaire's own opening follows that edge.
Axes axes_of_surface(const Luminaire& luminaire, const Vec3d& axis, const Vec3d& longest) {
  const Vec3d& size = luminaire.opening.size;
  return axes_about(axis, size.y > size.x * 1.0001 ? cross(axis, longest) : longest);
}

float factor_of_tilt(const Luminaire& luminaire, const Vec3d& nadir, const Vec3d& down) {
  const double cosine = dot(normalize(nadir), normalize(down));
  return float(tilt_factor(luminaire, deg_from_rad(std::acos(std::clamp(cosine, -1.0, 1.0)))));
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
      is_named = is_named || (e.name == node && e.geometry == m &&
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

void set_web(Light& e, int32_t web, const Axes& axes, Rgb scale) {
  e.web = web;
  e.axes = axes;
  e.radiance = scale;
}

// Sets the faces of a flat opening, one or two, and returns true if it shines to both sides.
bool set_flat_opening(LightWeb& web, double area) {
  const bool is_two_sided = shines_towards(web, {0, 0, -1});
  web.faces = {Vec3{0, 0, float(area)}};
  if (is_two_sided) web.faces.push_back(Vec3{0, 0, -float(area)});
  return is_two_sided;
}

void attach_to_meshes(Scene& scene, const std::string& node, const Luminaire& luminaire, Rgb scale,
                      const Vec3d& down) {
  const Opening o = opening_of(scene, node);
  const bool is_known =
      !o.meshes.empty() || std::any_of(scene.lights.begin(), scene.lights.end(),
                                       [&](const Light& e) { return e.name == node; });
  if (!is_known) throw UsageError("--luminaire: " + no_node_named(scene, node));
  if (!(length(o.area_vector) >= least_flatness * o.area) || !(o.area > 0))
    throw UsageError("--luminaire: '" + node + "' is neither a flat surface nor a point");
  const Vec3d axis = normalize(o.area_vector);
  const auto axes = axes_of_surface(luminaire, axis, o.longest_edge);
  scale *= factor_of_tilt(luminaire, axis, down);
  const auto web = int32_t(scene.webs.size());
  scene.webs.push_back(luminaire.web);
  const bool is_two_sided = set_flat_opening(scene.webs.back(), o.area);
  for (const uint32_t m : o.meshes) {
    if (scene.meshes[m].lights.empty())
      add_mesh_lights(scene, m, {node, Rgb{1}, no_texture, is_two_sided});
    for (Light& e : scene.lights) {
      if ((e.kind != LightKind::polygon && e.kind != LightKind::mesh) || e.geometry != m) continue;
      set_web(e, web, axes, scale);
      e.texture = no_texture;
      e.is_two_sided = is_two_sided;
    }
  }
}

// Attaches the luminaire to a point, spot, disk or sphere; false for other lights.
bool attach_to_light(Scene& scene, Light& e, const Luminaire& luminaire, Rgb scale,
                     const Vec3d& down) {
  const auto web = int32_t(scene.webs.size());
  Vec3d axis = normalize(down);
  LightWeb own = luminaire.web;
  switch (e.kind) {
    case LightKind::spot:
      axis = normalize(Vec3d(e.direction));
      break;
    case LightKind::point:
      break;
    case LightKind::disk:
      axis = normalize(Vec3d(scene.disks[e.geometry].normal));
      e.is_two_sided = set_flat_opening(own, pi * sqr(double(scene.disks[e.geometry].radius)));
      break;
    case LightKind::sphere:
      own.cross_section = pi_f * sqr(scene.spheres[e.geometry].radius);
      e.is_two_sided = false;
      break;
    case LightKind::polygon:
    case LightKind::mesh:
    case LightKind::distant:
    case LightKind::environment:
    case LightKind::sky:
    case LightKind::sun:
      return false;
  }
  if (!has_surface(e.kind)) e.kind = LightKind::point;
  set_web(e, web, axes_about(axis, Framed(axis).tangent),
          scale * factor_of_tilt(luminaire, axis, down));
  scene.webs.push_back(std::move(own));
  return true;
}

uint32_t add_black(Scene& scene) {
  Material black;
  black.base_color.value = Rgb{0};
  scene.materials.push_back(black);
  return uint32_t(scene.materials.size()) - 1;
}

// Each face becomes a mesh of its own, so that each is a separate, flat light.
void add_faces(Scene& scene, const std::string& name, const OpeningBody& body, const LightWeb& web,
               const Axes& axes, const Vec3d& position) {
  const auto world = [&](const Vec3d& p) {
    return Vec3d(axes[0]) * p.x + Vec3d(axes[1]) * p.y + Vec3d(axes[2]) * p.z;
  };
  const bool is_flat = body.faces.size() == 1;
  const bool is_two_sided = is_flat && web.faces.size() == 2;
  const uint32_t black = add_black(scene);
  for (const OpeningFace& face : body.faces) {
    Mesh mesh;
    mesh.name = name;
    mesh.material = black;
    for (const Vec3d& p : face.outline) mesh.positions.push_back(Vec3(position + world(p)));
    // The luminaire's axes may be left-handed.
    const std::vector<Vec3>& v = mesh.positions;
    const Vec3d normal = cross(Vec3d(v[1]) - Vec3d(v[0]), Vec3d(v[2]) - Vec3d(v[0]));
    if (dot(normal, world(face.area)) < 0)
      std::reverse(mesh.positions.begin(), mesh.positions.end());
    for (uint32_t i = 1; i + 1 < v.size(); ++i) mesh.triangles.push_back({0, i, i + 1});
    scene.meshes.push_back(std::move(mesh));
    if (is_flat || shines_towards(web, face.area))
      add_mesh_lights(scene, uint32_t(scene.meshes.size()) - 1,
                      {name, Rgb{1}, no_texture, is_two_sided});
  }
}

void add_disc(Scene& scene, const OpeningBody& body, const LightWeb& web, const Axes& axes,
              const Vec3d& position) {
  Light e;
  e.kind = LightKind::disk;
  e.geometry = uint32_t(scene.disks.size());
  e.is_two_sided = web.faces.size() == 2;
  Disk disk;
  disk.centre = Vec3(position);
  disk.normal = axes[2];
  disk.radius = float(body.radius);
  disk.material = add_black(scene);
  disk.light = int32_t(scene.lights.size());
  scene.disks.push_back(disk);
  scene.lights.push_back(std::move(e));
}

void add_sphere(Scene& scene, const OpeningBody& body, const Vec3d& position) {
  Light e;
  e.kind = LightKind::sphere;
  e.geometry = uint32_t(scene.spheres.size());
  Sphere sphere;
  sphere.centre = Vec3(position);
  sphere.radius = float(body.radius);
  sphere.material = add_black(scene);
  sphere.light = int32_t(scene.lights.size());
  scene.spheres.push_back(sphere);
  scene.lights.push_back(std::move(e));
}

}  // namespace

int32_t add_web(Scene& scene, const Luminaire& luminaire) {
  const auto number = int32_t(scene.webs.size());
  LightWeb web = luminaire.web;
  const OpeningBody body = body_of(luminaire.opening);
  if (body.shape == OpeningBody::Shape::sphere)
    web.cross_section = float(pi * sqr(body.radius));
  else if (body.shape == OpeningBody::Shape::disc)
    set_flat_opening(web, pi * sqr(body.radius));
  else
    for (const OpeningFace& face : body.faces) web.faces.push_back(Vec3(face.area));
  if (body.faces.size() == 1 && shines_towards(web, -body.faces[0].area))
    web.faces.push_back(-web.faces[0]);
  scene.webs.push_back(std::move(web));
  return number;
}

void add_luminaire(Scene& scene, const std::string& name, const Luminaire& luminaire, int32_t web,
                   Rgb scale, const LuminairePlace& place) {
  const auto axes = axes_about(normalize(place.nadir), place.along);
  scale *= factor_of_tilt(luminaire, place.nadir, place.down);
  const OpeningBody body = body_of(luminaire.opening);
  const LightWeb& own = scene.webs[size_t(web)];
  const auto first = scene.lights.size();
  switch (body.shape) {
    case OpeningBody::Shape::point: {
      Light e;
      e.kind = LightKind::point;
      e.position = Vec3(place.position);
      scene.lights.push_back(std::move(e));
      break;
    }
    case OpeningBody::Shape::sphere:
      add_sphere(scene, body, place.position);
      break;
    case OpeningBody::Shape::disc:
      add_disc(scene, body, own, axes, place.position);
      break;
    case OpeningBody::Shape::faces:
      add_faces(scene, name, body, own, axes, place.position);
      break;
  }
  for (size_t i = first; i < scene.lights.size(); ++i) {
    scene.lights[i].name = name;
    set_web(scene.lights[i], web, axes, scale);
  }
}

namespace {

// Turns instances of that name into plain meshes, because instances cannot emit.
void copy_out(Scene& scene, const std::string& name) {
  std::erase_if(scene.instances, [&](const Instance& i) {
    if (i.name != name) return false;
    scene.meshes.push_back(copied_to_world(MeshInWorld(scene.instanced_meshes[i.mesh], &i)));
    return true;
  });
}

}  // namespace

void attach_luminaire(Scene& scene, const std::string& node, const Luminaire& luminaire, Rgb scale,
                      const Vec3& down) {
  copy_out(scene, node);
  bool is_light = false;
  for (Light& e : scene.lights)
    if (e.name == node && attach_to_light(scene, e, luminaire, scale, Vec3d(down))) is_light = true;
  if (!is_light) attach_to_meshes(scene, node, luminaire, scale, Vec3d(down));
}

}  // namespace troffer
