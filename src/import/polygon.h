// Triangulation of polygons, for the faces of OBJ and Radiance files. It handles convex and concave
// polygons; holes are not supported.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "scene/scene.h"

namespace troffer {

// Appends the triangles of a polygon with at least three corners at `points`. They hold corner
// numbers (0 to points.size() - 1) and keep the polygon's winding.
// Convex polygons become fans. Others are cut by ears up to a limit on corners and effort; the rest
// becomes a fan, which is right only where it is convex.
void triangulate(std::span<const Vec3> points, std::vector<Triangle>& triangles);

}  // namespace troffer
