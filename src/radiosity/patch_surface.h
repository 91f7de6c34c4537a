// A patch as a source that is sampled like a light: the unit square over its area, equal areas
// to equal areas (light/source_surface.h).
#pragma once

#include "light/source_surface.h"
#include "radiosity/meshing.h"

namespace troffer {

// Normals are on the side that shoots. A patch that is one parallelogram (the usual case where
// small triangles were joined) is laid out as one; a triangle is a fan about the corner opposite
// its longest edge; pieces that make no convex polygon together follow each other along the axis
// of their longest extent.
SourceSurface patch_surface(const RadiosityMesh& mesh, uint32_t patch);

// Where a shadow ray to a point of patch_surface ends: a little in front of it; patches of spheres:
// of the sphere, which their pieces lie within.
Vec3 ray_target(const RadiosityMesh& mesh, uint32_t patch, const SourcePoint& at);

}  // namespace troffer
