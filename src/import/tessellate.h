// Tessellation of curved shapes in object space: positions, smooth unit normals and (u,v). The
// front is the side of dp/du × dp/dv, with pbrt's parametrisations. Used by the importers of pbrt
// and Radiance and by placed_geometry.h.
#pragma once

#include <array>

#include "base/vec.h"
#include "scene/scene.h"

namespace troffer {

// Returns the part of a sphere around the origin with z in [z_min, z_max] and azimuth in [0,
// phi_max_rad]; the front is outside.
Mesh tessellate_sphere(double radius, double z_min, double z_max, double phi_max_rad);

// Returns the part of a disk around the z axis at z = height with radii in [inner_radius, radius]
// and azimuth in [0, phi_max_rad]; the front is +z.
Mesh tessellate_disk(double height, double radius, double inner_radius, double phi_max_rad);

// Returns the part of a cylinder around the z axis with z in [z_min, z_max] and azimuth in [0,
// phi_max_rad]; the front is outside.
Mesh tessellate_cylinder(double radius, double z_min, double z_max, double phi_max_rad);

// Corners, normals (used if is_smooth) and (u,v) of a bilinear patch in pbrt's order: 00, 10, 01,
// 11.
struct BilinearPatch {
  std::array<Vec3, 4> corners;
  std::array<Vec3, 4> normals;
  std::array<Vec2, 4> uvs{Vec2{0, 0}, Vec2{1, 0}, Vec2{0, 1}, Vec2{1, 1}};
  bool is_smooth = false;
};
// True if the corners lie in one plane, so that two triangles equal the patch.
bool is_planar(const BilinearPatch& patch);
// Appends the patch to `mesh`, as cells × cells quads of two triangles each. Writes normals if
// `mesh` has some, or if it is empty and the patch is smooth or cells > 1.
void append_patch(Mesh& mesh, const BilinearPatch& patch, int cells);

}  // namespace troffer
