// Sample points on the surfaces of lights, nearly uniform in solid angle from a receiver, with
// densities and inverses. Emission, and lights without surface, are in light.h.
//
// Beyond 32 radii of the piece's bounding sphere, points are uniform in area. Distances then vary
// by at most 1/32 each way. That changes the weight by at most 13 % (rms below 2 % for a source
// that faces the receiver). Single precision receivers do not resolve the solid angle better at
// that distance. Nearer, by shape:
//   rectangle      uniform in solid angle [1], in double precision under 2e-3 sr
//   triangle       uniform in solid angle [2]
//   polygon        fan of triangles about vertex 0, chosen by solid angle: uniform in solid angle
//   disk           nearly uniform in solid angle (spherical_disk.h)
//   sphere         uniform in solid angle, at any distance; from inside, over all directions
// References: [1] Ureña, Fajardo & King, "An Area-Preserving Parametrization for Spherical
//   Rectangles", EGSR 2013.
//   [2] Arvo, "Stratified Sampling of Spherical Triangles", SIGGRAPH 1995.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "light/light_primitive.h"

namespace troffer {

// A sampled point of a light, seen from a receiver.
struct LightSample {
  Vec3 point;                 // on the light; undefined for lights at infinity
  Vec3 normal;                // unit, on the receiver's side; 0 without surface
  Vec2 texture_uv;            // triangles of mesh lights; else (0,0)
  Vec3 wi;                    // unit, from the receiver to the point
  float distance = 0;         // metres; infinite for lights at infinity
  float pdf_solid_angle = 0;  // per steradian, > 0; 1 where is_delta
  bool is_front = true;       // the receiver is on the light's front
  // Set by the functions of light.h:
  bool is_delta = false;  // only this direction brings light, and no ray finds it by chance
  Rgb radiance;           // W/(m² sr) or cd/m²; delta: irradiance on a surface that faces it
};

// Samples a point of `p` that faces receiver x, from u in [0,1)². Returns false if no point does
// (back of a one-sided light, or its own plane) or if the solid angle vanishes.
bool sample(const LightPrimitive& p, const Vec3& x, const Vec2& u, LightSample& out);

// Scratch memory of sample_many().
struct LightSampleScratch {
  std::vector<uint32_t> index;
  // in units of the piece's radius
  std::vector<float> corner_x, corner_y, size_x, size_y, height, u, v;
  std::vector<float> x, y, solid_angle;
};

// Calls sample(all[primitives[i]], receivers[i], (u[i], v[i]), out[i]) for n pieces. is_valid[i] is
// its result, or 0 for pieces without surface. Near rectangles are vectorized: their points may
// differ from those of sample() in the last bits, but do not depend on the rest of the batch.
void sample_many(const LightPrimitives& all, size_t n, const uint32_t* primitives,
                 const Vec3* receivers, const float* u, const float* v, LightSample* out,
                 uint8_t* is_valid, LightSampleScratch& scratch);

// Density per steradian with which sample() for receiver x chooses the direction wi, where a ray
// from x along wi hits p at `distance`. Returns 0 if sample() never returns that point.
float pdf_solid_angle(const LightPrimitive& p, const Vec3& x, const Vec3& wi, float distance);

// Returns the u for which sample() returns `point` of p. Meaningful where sample() can return it.
Vec2 square_from_point(const LightPrimitive& p, const Vec3& x, const Vec3& point);

}  // namespace troffer
