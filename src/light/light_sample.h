// Points on the surfaces of lights, chosen for a receiver nearly in proportion to solid angle;
// densities and inverses of that choice. What they emit, and lights without surface: light.h.
//
// From a receiver farther than 32 radii of the piece's bounding sphere, points are chosen uniformly
// by area: distances then differ by at most 1/32 each way, which moves the weight by at most 13 %
// (rms under 2 % for a source that faces the receiver), and the float position of the receiver
// stops resolving the solid angle's fine structure. Nearer, by shape:
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

struct LightSample {
  Vec3 point;                 // on the light; undefined for lights at infinity
  Vec3 normal;                // unit, on the side towards the receiver; 0 without surface
  Vec2 texture_uv;            // triangles of mesh sources; else (0,0)
  Vec3 wi;                    // unit, from the receiver to the point
  float distance = 0;         // metres; infinite for lights at infinity
  float pdf_solid_angle = 0;  // per steradian, > 0; 1 where is_delta
  bool is_front = true;       // the receiver is on the light's front
  // Filled in by light.h:
  bool is_delta = false;  // no other direction brings light, and no ray by chance finds this one
  Rgb radiance;           // W/(m² sr) or cd/m²; delta: irradiance on a surface that faces it
};

// Chooses a point of `p` that faces receiver x, from u in [0,1)². False where nothing of it does
// (the back of a one-sided light, its own plane) or the solid angle vanishes.
bool sample(const LightPrimitive& p, const Vec3& x, const Vec2& u, LightSample& out);

// Memory for sample_many.
struct LightSampleScratch {
  std::vector<uint32_t> index;
  std::vector<float> corner_x, corner_y, size_x, size_y, height, u, v;  // in radii of the piece
  std::vector<float> x, y, solid_angle;
};

// sample(all[primitives[i]], receivers[i], (u[i], v[i]), out[i]) for all i of n; is_valid[i] is
// what it returns, and 0 for pieces without surface. Near rectangles go together, several to a
// vector register: their points may differ from sample()'s in the last bits, and do not depend on
// what else is in the batch.
void sample_many(const LightPrimitives& all, size_t n, const uint32_t* primitives,
                 const Vec3* receivers, const float* u, const float* v, LightSample* out,
                 uint8_t* is_valid, LightSampleScratch& scratch);

// Density per steradian with which `sample` for receiver x chooses the direction wi, where a ray
// from x along wi hits p at `distance`. 0 where sample never does.
float pdf_solid_angle(const LightPrimitive& p, const Vec3& x, const Vec3& wi, float distance);

// The u for which `sample` returns `point` of p; meaningful where sample can return it.
Vec2 square_from_point(const LightPrimitive& p, const Vec3& x, const Vec3& point);

}  // namespace troffer
