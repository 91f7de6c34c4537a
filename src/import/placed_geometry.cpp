#include "import/placed_geometry.h"

#include <cmath>

#include "base/parallel.h"
#include "import/limits.h"
#include "import/mesh_clean.h"
#include "import/tessellate.h"

namespace troffer {

namespace {

constexpr double circle_tolerance = 1e-5;
constexpr size_t items_per_task = size_t(1) << 16;  // items per parallel task

}  // namespace

Vec3d covector(const Affine& t, const Vec3d& n) {
  return t.swaps_handedness() ? -t.normal(n) : t.normal(n);
}

Mesh transformed(const AnchoredMesh& local, const Affine& t, bool are_normals_turned,
                 bool is_winding_turned) {
  Mesh mesh = local.mesh;
  parallel_pieces(mesh.positions.size(), items_per_task, [&](size_t first, size_t end) {
    for (size_t i = first; i < end; ++i)
      mesh.positions[i] = Vec3(t.point(local.anchor + Vec3d(mesh.positions[i])));
  });
  parallel_pieces(mesh.normals.size(), items_per_task, [&](size_t first, size_t end) {
    for (size_t i = first; i < end; ++i) {
      const Vec3d turned = covector(t, Vec3d(mesh.normals[i]));
      // Normalise here, so that small scales do not underflow in float.
      const double size = length(turned);
      mesh.normals[i] = size > 0 && std::isfinite(size)
                            ? Vec3(turned * ((are_normals_turned ? -1 : 1) / size))
                            : Vec3{};
    }
  });
  orient(mesh, is_winding_turned);
  return mesh;
}

void add_bounds(const AnchoredMesh& local, const Affine& target_from_local, PlacedBounds& bounds) {
  const std::vector<Vec3>& p = local.mesh.positions;
  const auto at = [&](uint32_t v) { return target_from_local.point(local.anchor + Vec3d(p[v])); };
  bounds.add_triangles(local.mesh.triangles, at);
}

namespace {

void orient(const Mesh& mesh, Triangle& t, bool is_turned) {
  double side = 0;
  if (!mesh.normals.empty()) {
    const Vec3d n =
        Vec3d(mesh.normals[t[0]]) + Vec3d(mesh.normals[t[1]]) + Vec3d(mesh.normals[t[2]]);
    side = dot(area_vector(mesh, t), n);
  }
  if (side < 0 || (!(side > 0) && is_turned)) std::swap(t[1], t[2]);
}

}  // namespace

void orient(Mesh& mesh, bool is_turned) {
  parallel_pieces(mesh.triangles.size(), items_per_task, [&](size_t first, size_t end) {
    for (size_t i = first; i < end; ++i) orient(mesh, mesh.triangles[i], is_turned);
  });
}

bool keeps_circles(const Affine& t, size_t axis_a, size_t axis_b) {
  const Vec3d &a = t.columns[axis_a], &b = t.columns[axis_b];
  const double la = length(a), lb = length(b);
  return la > 0 && lb > 0 && std::abs(la - lb) <= circle_tolerance * la &&
         std::abs(dot(a, b)) <= circle_tolerance * la * lb;
}

void GeometryPlacer::spend(size_t triangles, const SourcePlace& place) {
  cost_ += std::max(triangles, least_shape_cost);
  if (cost_ > max_scene_triangles)
    place.fail("the scene has too much geometry (over " +
               std::to_string(max_scene_triangles / 1'000'000) + " million triangles)");
}

bool GeometryPlacer::needs_coordinates(const ShapeAttributes& look) const {
  const Material& m = scene_.materials[look.material];
  return has_textured_input(m) || m.normal_texture >= 0 || m.bump.texture >= 0 ||
         has_own_coat_normal(m) || m.anisotropy.value > 0 || m.is_alpha_masked ||
         (look.emission && look.emission->texture >= 0);
}

int32_t GeometryPlacer::add_light(const ShapeAttributes& look, LightKind kind, size_t geometry) {
  if (!look.emission || look.emission->radiance.is_black()) return no_light;
  Light e;
  e.name = look.emission->name;
  e.kind = kind;
  e.radiance = look.emission->radiance;
  e.is_two_sided = look.emission->is_two_sided;
  e.geometry = uint32_t(geometry);
  scene_.lights.push_back(std::move(e));
  return int32_t(scene_.lights.size()) - 1;
}

// Without normals, the winding in the world decides the front, and a mirroring transform reverses
// it. Instances keep their front, so the stored mesh is wound to look the same.
bool GeometryPlacer::add_instance(const AnchoredMesh& local, const Affine& world_from_local,
                                  bool is_turned, const ShapeAttributes& look) {
  if (look.shape == nullptr || (look.emission && !look.emission->radiance.is_black())) return false;
  const size_t triangles = local.mesh.triangles.size();
  const bool is_mirrored = local.mesh.normals.empty() && world_from_local.swaps_handedness();
  const bool is_winding_turned = is_turned != is_mirrored;
  Affine t = world_from_local * Affine::translate(local.anchor);
  t.translation -= scene_.origin;
  const auto make = [&] {
    spend(triangles, look.place);
    Mesh mesh = transformed({local.mesh, {}}, Affine(), is_turned, is_winding_turned);
    mesh.lights.clear();
    clean_mesh(mesh, scene_.warnings);
    mesh.material = look.material;
    if (needs_coordinates(look)) add_default_uvs(mesh);
    return mesh;
  };
  const uint32_t variant = (is_turned ? 1u : 0u) | (is_winding_turned ? 2u : 0u);
  if (!instancer_.place({look.shape, look.material, variant}, triangles, t, "", make)) return false;
  spend(1, look.place);
  placed_triangles_ += triangles;
  if (placed_triangles_ > max_placed_triangles) look.place.fail(too_many_by_instances());
  return true;
}

void GeometryPlacer::add_mesh(const AnchoredMesh& local, const Affine& world_from_local,
                              bool is_turned, const ShapeAttributes& look) {
  if (add_instance(local, world_from_local, is_turned, look)) return;
  spend(std::max(local.mesh.triangles.size(), local.mesh.positions.size() / 3), look.place);
  Affine t = world_from_local;
  t.translation -= scene_.origin;
  add_bounds(local, t, bounds_);
  Mesh mesh = transformed(local, t, is_turned, is_turned);
  mesh.lights.clear();
  clean_mesh(mesh, scene_.warnings);
  if (mesh.triangles.empty()) {
    if (look.emission) scene_.warnings.add("area light without area is left out");
    return;
  }
  mesh.material = look.material;
  if (needs_coordinates(look)) add_default_uvs(mesh);
  scene_.meshes.push_back(std::move(mesh));
  if (look.emission) add_mesh_lights(scene_, uint32_t(scene_.meshes.size() - 1), *look.emission);
}

void GeometryPlacer::add_sphere(const Affine& world_from_local, const Vec3d& centre, double radius,
                                bool is_turned, const ShapeAttributes& look) {
  const Affine t = world_from_local * Affine::translate(centre);
  const bool is_round = keeps_circles(t, 0, 1) && keeps_circles(t, 1, 2) && keeps_circles(t, 2, 0);
  if (!is_round || needs_coordinates(look)) {
    AnchoredMesh mesh{tessellate_sphere(radius, -radius, radius, 2 * pi), {}};
    for (Vec2& uv : mesh.mesh.uvs) uv.y = 1 - uv.y;  // v runs down from the pole +z
    add_mesh(mesh, t, is_turned, look);
    return;
  }
  spend(1, look.place);
  const Vec3d middle = t.translation - scene_.origin;
  const double r = radius * length(t.columns[0]);
  bounds_.add_ball(middle, r);
  Sphere sphere;
  sphere.centre = Vec3(middle);
  sphere.radius = float(r);
  sphere.is_inside_out = is_turned;
  sphere.material = look.material;
  if (!is_finite(sphere.centre) || !(sphere.radius > 0) || !std::isfinite(sphere.radius)) {
    scene_.warnings.add("sphere that is not finite or has no area is left out");
    return;
  }
  sphere.light = add_light(look, LightKind::sphere, scene_.spheres.size());
  scene_.spheres.push_back(sphere);
}

void GeometryPlacer::add_disk(const Affine& world_from_local, double radius, bool is_turned,
                              const ShapeAttributes& look) {
  const Affine& t = world_from_local;
  if (!keeps_circles(t, 0, 1) || needs_coordinates(look)) {
    add_mesh({tessellate_disk(0, radius, 0, 2 * pi), {}}, t, is_turned, look);
    return;
  }
  spend(1, look.place);
  const Vec3d middle = t.translation - scene_.origin;
  const double r = radius * length(t.columns[0]);
  bounds_.add_ball(middle, r);
  // The two columns are not parallel, so their cross product has a length.
  Vec3d axis = normalize(cross(t.columns[0], t.columns[1]));
  if (t.swaps_handedness() != is_turned) axis = -axis;
  Disk disk;
  disk.centre = Vec3(middle);
  disk.normal = Vec3(axis);
  disk.radius = float(r);
  disk.material = look.material;
  if (!is_finite(disk.centre) || !is_finite(disk.normal) || !(disk.radius > 0) ||
      !std::isfinite(disk.radius)) {
    scene_.warnings.add("disk that is not finite or has no area is left out");
    return;
  }
  disk.light = add_light(look, LightKind::disk, scene_.disks.size());
  scene_.disks.push_back(disk);
}

}  // namespace troffer
