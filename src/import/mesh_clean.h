// Meshes made fit for a scene: nothing in them that is not finite, and no triangle without area.
#pragma once

#include "base/log.h"
#include "scene/scene.h"

namespace troffer {

// In place, for a mesh whose winding is final:
// - triangles that TriangleCheck refuses are left out, with a counted warning;
// - vertices that are not finite are removed;
// - normals become unit vectors; one that cannot (zero, not finite) becomes the area-weighted mean
//   of the triangles around it;
// - (u,v) that are not finite become (0,0).
// Triangle indices must be in range.
void clean_mesh(Mesh& mesh, WarningLog& warnings);

// Makes a mesh, cleaned, all that a scene without materials shows, with one of the usual kind; a
// warning where nothing is left of it.
void show_alone(Mesh mesh, Scene& scene);

// Twice the area times the unit normal of the front.
inline Vec3d area_vector(const Mesh& mesh, const Triangle& t) {
  const Vec3d p0(mesh.positions[t[0]]), p1(mesh.positions[t[1]]), p2(mesh.positions[t[2]]);
  return cross(p1 - p0, p2 - p0);
}

// m².
double area_of(const Mesh& mesh);

// Gives every triangle vertices of its own with (u,v) = (0,0), (1,0), (1,1): what pbrt assumes for
// meshes without coordinates. Does nothing where there are some.
void add_default_uvs(Mesh& mesh);

}  // namespace troffer
