#include "scene/mesh_in_world.h"

#include <algorithm>
#include <cmath>

namespace troffer {

namespace {

constexpr double most_growth = 8;

std::array<Vec3d, 3> abs_columns(const Affine& a) {
  return {abs(a.columns[0]), abs(a.columns[1]), abs(a.columns[2])};
}

double largest(const Vec3d& v) {
  return std::max({v.x, v.y, v.z});
}

// Growth of rounding errors of coordinates on the way to the mesh and back: the row sum norm
// of |M| |M^-1|. It is 1 if M scales along the axes, at most 3 for rotations, and infinite or NaN
// if M is singular.
double growth_of_rounding(const Affine& m) {
  const std::array<Vec3d, 3> there = abs_columns(inverse(m)), back = abs_columns(m);
  const Vec3d sums = there[0] + there[1] + there[2];
  return largest(back[0] * sums.x + back[1] * sums.y + back[2] * sums.z);
}

}  // namespace

Vec3 MeshInWorld::in_world(const Vec3& normal) const {
  const Affine& m = instance_->world_from_mesh;
  // Affine::normal carries the sign of the determinant, but a normal must not change sides.
  const Vec3d n = m.normal(Vec3d(normal)) * (instance_->is_mirrored ? -1.0 : 1.0);
  const double size = length(n);
  return size > 0 && std::isfinite(size) ? Vec3(n / size) : normal;
}

bool is_instanceable(const Affine& m) {
  constexpr double largest_scale = 1e9, smallest_volume = 1e-27;  // within the range of floats
  const double det = std::abs(m.determinant());
  if (!(det > smallest_volume) || !(length(m.translation) < largest_scale)) return false;
  for (const Vec3d& column : m.columns)
    if (!(length(column) < largest_scale)) return false;
  return growth_of_rounding(m) <= most_growth;
}

Box bounds_in_world(const Mesh& mesh, const Affine& world_from_mesh) {
  Boxd box;
  for (const Vec3& p : mesh.positions) box.grow(world_from_mesh.point(Vec3d(p)));
  return {Vec3(box.lower), Vec3(box.upper)};  // rounded as positions are
}

Vec3 reach_of(const Mesh& mesh) {
  Vec3 reach;
  for (const Vec3& p : mesh.positions) reach = max(reach, abs(p));
  return reach;
}

Instance make_instance(uint32_t number, const Affine& world_from_mesh, std::string name,
                       const Vec3& reach, const Box& bounds) {
  Instance out;
  out.name = std::move(name);
  out.mesh = number;
  out.world_from_mesh = world_from_mesh;
  out.is_mirrored = world_from_mesh.swaps_handedness();
  out.bounds = bounds;
  const std::array<Vec3d, 3> back = abs_columns(world_from_mesh);
  const Vec3d sum = back[0] * double(reach.x) + back[1] * double(reach.y) +
                    back[2] * double(reach.z) + abs(world_from_mesh.translation);
  out.reach = float(largest(sum) * std::max(1.0, growth_of_rounding(world_from_mesh)));
  return out;
}

Mesh copied_to_world(const MeshInWorld& from) {
  Mesh out = from.mesh();
  if (from.instance() == nullptr) return out;
  out.name = from.name();
  for (uint32_t v = 0; v < out.positions.size(); ++v) out.positions[v] = from.position(v);
  for (uint32_t v = 0; v < out.normals.size(); ++v) out.normals[v] = from.normal(v);
  for (size_t i = 0; i < out.triangles.size(); ++i) out.triangles[i] = from.triangle(i);
  return out;
}

}  // namespace troffer
