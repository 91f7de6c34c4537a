// What every method may ask of a light, whatever its kind. The kinds are a closed set
// (scene/light.h): each has a file of its own here (surface_light.h, point_light.h, …) that answers
// all questions, and light.cpp picks the file by Light::kind, in one place.
//
//   bound        LightPrimitive: box, cone of directions, power (LightPrimitives makes them)
//   sample       a direction, distance, radiance and density towards a receiver
//   density      of a direction in which a ray hits the light, or leaves the scene
//   emission     at a hit, by position and direction; and for rays that leave the scene
//   certificate  the shape by which its visibility can be proved, or none
#pragma once

#include <memory>

#include "light/light_primitive.h"
#include "light/light_sample.h"

namespace troffer {

// Chooses a point or direction of piece p for receiver x, with the radiance that it sends there.
// False where nothing of p can send light to x.
bool sample(const Scene& scene, const LightPrimitive& p, const Vec3& x, const Vec2& u,
            LightSample& out);

// The same for all i of n: piece primitives[i], receivers[i], (u[i], v[i]); is_valid[i] is what
// sample() returns. Near rectangles go together (light_sample.h).
void sample_many(const Scene& scene, const LightPrimitives& all, size_t n,
                 const uint32_t* primitives, const Vec3* receivers, const float* u, const float* v,
                 LightSample* out, uint8_t* is_valid, LightSampleScratch& scratch);

// Density per steradian with which sample() for receiver x chooses the direction wi, in which a ray
// from x meets p at `distance` (infinite for lights at infinity). 0 for deltas, which no ray meets.
float pdf_solid_angle(const Scene& scene, const LightPrimitive& p, const Vec3& x, const Vec3& wi,
                      float distance);

// Radiance that leaves a light's surface, on its front or back where its texture coordinates are
// uv, in the unit direction `towards`.
Rgb emitted_radiance(const Scene& scene, const Light& light, bool is_front, const TexturePlace& uv,
                     const Vec3& towards);

// Radiance from beyond the scene, in the direction wi, whatever it comes through.
Rgb radiance_beyond(const Scene& scene, const Light& light, const Vec3& wi);

// Radiance of piece p that a ray sees which leaves the scene in the unit direction wi, from x.
Rgb radiance_at_infinity(const Scene& scene, const LightPrimitive& p, const Vec3& x,
                         const Vec3& wi);

// By which directions towards a light at infinity are drawn; null for kinds that need no table.
std::unique_ptr<const DirectionTable> make_directions(const Scene& scene, const Light& light);

// The one piece of a light without surface, drawn by `directions` (which must outlive it);
// `scene_bounds` says how much of a light at infinity enters the scene.
LightPrimitive make_piece(const Scene& scene, const Light& light, const Box& scene_bounds,
                          const DirectionTable* directions);

// What the light of a piece without surface comes through alone; null for most.
std::unique_ptr<const Portal> make_portal(const Scene& scene, const Light& light,
                                          const LightPrimitive& p);

// By which shape of its pieces a light's visibility can be proved (docs/certified.md).
enum class CertificateShape : uint8_t { none, flat, sphere };
CertificateShape certificate_shape(const Scene& scene, const Light& light);

}  // namespace troffer
