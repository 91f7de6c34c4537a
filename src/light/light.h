// Queries that all kinds of lights answer. The kinds are a closed set (scene/light.h). Each kind
// has a file here (surface_light.h, point_light.h and so on) that implements all queries; light.cpp
// selects it by Light::kind.
//
//   bound        LightPrimitive: box, cone of directions, power (for LightPrimitives)
//   sample       a direction towards a receiver, its distance, radiance and density
//   density      of a direction in which a ray hits the light or leaves the scene
//   emission     at a hit, by position and direction; and for rays that leave the scene
//   certificate  the shape by which its visibility can be proved, or none
#pragma once

#include <memory>

#include "light/light_primitive.h"
#include "light/light_sample.h"

namespace troffer {

// Samples a point or direction of piece p for receiver x, with the radiance that it sends there.
// Returns false if no light of p can reach x.
bool sample(const Scene& scene, const LightPrimitive& p, const Vec3& x, const Vec2& u,
            LightSample& out);

// Calls sample() for n pieces primitives[i], receivers[i] and numbers (u[i], v[i]). is_valid[i] is
// the result of sample(). Near rectangles are vectorized (light_sample.h).
void sample_many(const Scene& scene, const LightPrimitives& all, size_t n,
                 const uint32_t* primitives, const Vec3* receivers, const float* u, const float* v,
                 LightSample* out, uint8_t* is_valid, LightSampleScratch& scratch);

// Density per steradian with which sample() for receiver x chooses the direction wi, in which a ray
// from x meets p at `distance` (infinite for environment lights). Returns 0 for delta lights, which
// no ray meets.
float pdf_solid_angle(const Scene& scene, const LightPrimitive& p, const Vec3& x, const Vec3& wi,
                      float distance);

// True if samples of piece p have the directions of a fixed function of u, for all receivers.
bool has_square_of_direction(const Scene& scene, const LightPrimitive& p);
// Returns the u for which sample() gives the direction wi, for such a piece. Meaningful where its
// density is not 0.
Vec2 square_of_direction(const Scene& scene, const LightPrimitive& p, const Vec3& wi);

// Radiance that leaves a light's surface in the unit direction `towards`, from its front or back,
// at the texture coordinates uv.
Rgb emitted_radiance(const Scene& scene, const Light& light, bool is_front, const TexturePlace& uv,
                     const Vec3& towards);

// Radiance from beyond the scene in direction wi, regardless of portals.
Rgb radiance_beyond(const Scene& scene, const Light& light, const Vec3& wi);

// Radiance of piece p for a ray that leaves the scene from x in the unit direction wi. 0 if the
// piece's portal does not show that direction.
Rgb radiance_at_infinity(const Scene& scene, const LightPrimitive& p, const Vec3& x,
                         const Vec3& wi);

// Returns the table for sampling the directions of a light at infinity; null for kinds that need
// none.
std::unique_ptr<const DirectionTable> make_directions(const Scene& scene, const Light& light);

// Returns the only piece of a light without surface. `directions` must outlive it. scene_bounds
// determines the power of a light at infinity.
LightPrimitive make_piece(const Scene& scene, const Light& light, const Box& scene_bounds,
                          const DirectionTable* directions);

// Returns the portal of a piece without surface; null for most.
std::unique_ptr<const Portal> make_portal(const Scene& scene, const Light& light,
                                          const LightPrimitive& p);

// The shape of a light's pieces by which its visibility can be proved (docs/method/certified.md).
enum class CertificateShape : uint8_t { none, flat, sphere };
CertificateShape certificate_shape(const Scene& scene, const Light& light);

}  // namespace troffer
