// Exact unoccluded irradiance of diffuse sources per unit radiance: the projected solid angle in
// sr, between 0 and pi. Multiplied by the radiance it is the irradiance.
//
// In all functions x is the receiver and n its unit normal. Only the part above the receiver's
// horizon counts, and clipping is exact. Only the source's front counts unless Sides::both is
// given. A receiver in the plane of a flat source gets 0. Inputs are taken as exact. Relative
// errors are below 1e-8 at distances of 1e-4 to 1e3 source sizes, unless noted.
// References: [1] Lambert's formula for polygons, as in Arvo, "Analytic Methods for Simulated Light
//   Transport", Yale 1995, §2; an edge adds half its angle times its plane's normal.
//   [2] Snyder, "Area Light Sources for Real-Time Graphics", MSR-TR-96-11, 1996 (sphere).
#pragma once

#include <span>

#include "base/vec.h"
#include "light/light_primitive.h"
#include "light/source_surface.h"

namespace troffer {

// The sides of a source that emit.
enum class Sides : uint8_t { front, both };

// Planar convex polygon, counterclockwise seen from its front [1].
double polygon_irradiance(std::span<const Vec3d> vertices, const Vec3d& x, const Vec3d& n,
                          Sides sides = Sides::front);

// Sphere [2], whose front is the outside unless is_inside_out. From inside, the source fills the
// receiver's hemisphere and the value is pi. Sides::front counts only the side that is the front.
double sphere_irradiance(const Vec3d& centre, double radius, const Vec3d& x, const Vec3d& n,
                         Sides sides = Sides::front, bool is_inside_out = false);

// Disk with unit normal m on its front. Sums Lambert's contour integral [1] in closed form over the
// part of the rim above the horizon, and over the chord along the horizon.
double disk_irradiance(const Vec3d& centre, const Vec3d& m, double radius, const Vec3d& x,
                       const Vec3d& n, Sides sides = Sides::front);

// One piece of a light; a two-sided one counts from both sides.
double irradiance(const LightPrimitive& p, const Vec3d& x, const Vec3d& n);

// Sum over the light's pieces that face x. It ignores that triangles of a mesh may hide each other:
// it is exact for convex meshes and an upper bound for others.
double irradiance(const LightPrimitives& primitives, uint32_t light, const Vec3d& x,
                  const Vec3d& n);

// The part `cell` of a parallelogram source, for the leaves of a bintree; optimized for frequent
// calls. Relative error below 3e-6, except where the horizon leaves only a sliver.
float cell_irradiance(const Parallelogram& source, const SourceCell& cell, const Vec3& x,
                      const Vec3& n, Sides sides = Sides::front);

}  // namespace troffer
