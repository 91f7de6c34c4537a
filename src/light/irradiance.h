// Exact unoccluded irradiance from diffuse sources, per unit radiance: the projected solid angle in
// steradians, between 0 and pi. Irradiance is this times the radiance; radiosity that leaves a
// Lambertian surface is that times the reflectance.
//
// Everywhere: x is the receiver, n its unit normal; only what stands above the receiver's horizon
// counts, exactly clipped. The front of a source counts, with Sides::both its back too. A receiver
// in the plane of a flat source gets 0. Inputs are taken as exact; errors are below 1e-8 relative
// between 1e-4 and 1e3 source sizes unless noted.
// References: [1] Lambert's formula for polygons, as in Arvo, "Analytic Methods for Simulated Light
//   Transport", Yale 1995, §2; an edge adds half its angle times its plane's normal.
//   [2] Snyder, "Area Light Sources for Real-Time Graphics", MSR-TR-96-11, 1996 (sphere).
#pragma once

#include <span>

#include "base/vec.h"
#include "light/light_primitive.h"
#include "light/source_surface.h"

namespace troffer {

enum class Sides : uint8_t { front, both };

// Planar convex polygon, counterclockwise seen from its front [1].
double polygon_irradiance(std::span<const Vec3d> vertices, const Vec3d& x, const Vec3d& n,
                          Sides sides = Sides::front);

// Sphere. Outside it: [2] (front: the outside). Inside or with is_inside_out: the receiver sees the
// source in every direction of its hemisphere, so that the value is pi; Sides::front counts only
// the side that is the front.
double sphere_irradiance(const Vec3d& centre, double radius, const Vec3d& x, const Vec3d& n,
                         Sides sides = Sides::front, bool is_inside_out = false);

// Disk with unit normal m on its front: Lambert's contour integral [1] over the part of the rim
// that is above the horizon, in closed form, and the chord that the horizon cuts.
double disk_irradiance(const Vec3d& centre, const Vec3d& m, double radius, const Vec3d& x,
                       const Vec3d& n, Sides sides = Sides::front);

// One piece of a source; a two-sided one counts from both sides.
double irradiance(const LightPrimitive& p, const Vec3d& x, const Vec3d& n);

// Whole sources: the sum over the light's pieces that face x. Hiding of a mesh source's triangles
// behind each other is not seen: the sum is exact for convex meshes, an upper bound for others.
double irradiance(const LightPrimitives& primitives, uint32_t light, const Vec3d& x,
                  const Vec3d& n);

// The part `cell` of a parallelogram source, for the leaves of a bintree: made to be called often.
// Relative error under 3e-6, except where the horizon leaves a sliver.
float cell_irradiance(const Parallelogram& source, const SourceCell& cell, const Vec3& x,
                      const Vec3& n, Sides sides = Sides::front);

}  // namespace troffer
