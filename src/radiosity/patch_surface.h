// Represents a patch as a source that is sampled like a light: the unit square maps to its area,
// equal areas to equal areas (light/source_surface.h). Normals are on the side that shoots. A patch
// that is one parallelogram, the usual case for joined triangles, is laid out as one. A triangle is
// a fan about the corner opposite its longest edge. Pieces that form no convex polygon are ordered
// along the axis of their longest extent.
#pragma once

#include "light/source_surface.h"
#include "radiosity/meshing.h"

namespace troffer {

SourceSurface patch_surface(const RadiosityMesh& mesh, uint32_t patch);

// Returns the end of a shadow ray to a point of patch_surface, slightly in front of it. For patches
// of spheres it lies in front of the sphere, which encloses the pieces.
Vec3 ray_target(const RadiosityMesh& mesh, uint32_t patch, const SourcePoint& at);

}  // namespace troffer
