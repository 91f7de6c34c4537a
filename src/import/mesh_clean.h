// Clean-up of imported meshes: afterwards nothing is NaN or infinite, and no triangle lacks area.
// Importers call it before a mesh enters the scene. It also holds small functions on the area of
// meshes.
#pragma once

#include "base/log.h"
#include "scene/scene.h"

namespace troffer {

// Cleans a mesh in place; its winding must be final and its indices in range:
// - triangles that TriangleCheck rejects are removed, with a counted warning;
// - vertices that are not finite are removed;
// - normals become unit vectors; one that cannot (zero, not finite) becomes the area-weighted mean
//   of the triangles around it;
// - (u,v) that are not finite become (0,0).
void clean_mesh(Mesh& mesh, WarningLog& warnings);

// Cleans a mesh and adds it to a scene without materials, with the default material. Warns if no
// triangle is left.
void add_only_mesh(Mesh mesh, Scene& scene);

// Returns twice the area times the unit normal of the front.
inline Vec3d area_vector(const Mesh& mesh, const Triangle& t) {
  const Vec3d p0(mesh.positions[t[0]]), p1(mesh.positions[t[1]]), p2(mesh.positions[t[2]]);
  return cross(p1 - p0, p2 - p0);
}

// Returns the area of a mesh, m².
double area_of(const Mesh& mesh);

// Gives every triangle vertices of its own with (u,v) = (0,0), (1,0), (1,1), as pbrt does for
// meshes without coordinates. Does nothing if the mesh has coordinates.
void add_default_uvs(Mesh& mesh);

}  // namespace troffer
