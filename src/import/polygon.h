// Polygons of vertex indices -> triangles.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "scene/scene.h"

namespace troffer {

// Appends the triangles of the polygon whose corner i has position points[i]; they name corners
// (0 … points.size() - 1) and wind as the polygon does. Convex polygons become fans; others have
// their ears cut, as long as that is quick (else the rest is a fan, right only where convex).
// At least three points.
void triangulate(std::span<const Vec3> points, std::vector<Triangle>& triangles);

}  // namespace troffer
