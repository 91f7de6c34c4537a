// Curved shapes as triangles, in object space: positions, smooth unit normals and (u,v), the front
// on the side of dp/du × dp/dv, in the parametrisations of pbrt.
#pragma once

#include <array>

#include "base/vec.h"
#include "scene/scene.h"

namespace troffer {

// The part of a sphere about the origin with z in [z_min, z_max] and azimuth in [0, phi_max_rad];
// the front is outside.
Mesh tessellate_sphere(double radius, double z_min, double z_max, double phi_max_rad);

// The part of a disk about the z axis at z = height with distance in [inner_radius, radius] and
// azimuth in [0, phi_max_rad]; the front is +z.
Mesh tessellate_disk(double height, double radius, double inner_radius, double phi_max_rad);

// The part of a cylinder about the z axis with z in [z_min, z_max] and azimuth in [0, phi_max_rad];
// the front is outside.
Mesh tessellate_cylinder(double radius, double z_min, double z_max, double phi_max_rad);

// Corners, normals (is_smooth) and (u,v) of a bilinear patch in pbrt's order: 00, 10, 01, 11.
struct BilinearPatch {
  std::array<Vec3, 4> corners;
  std::array<Vec3, 4> normals;
  std::array<Vec2, 4> uvs{Vec2{0, 0}, Vec2{1, 0}, Vec2{0, 1}, Vec2{1, 1}};
  bool is_smooth = false;
};
// Whether two triangles are exactly the patch: its corners lie in one plane.
bool is_planar(const BilinearPatch& patch);
// Appends the patch to `mesh`: two triangles where `cells` is 1, else cells × cells quads. Normals
// are written where mesh has normals (or is empty and the patch is smooth or cells > 1).
void append_patch(Mesh& mesh, const BilinearPatch& patch, int cells);

}  // namespace troffer
