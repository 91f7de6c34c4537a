// Connections from a vertex to points on lights, and the weights of multiple importance sampling.
// Shared by all methods that sample sources. Radiance is linear RGB; densities are per solid angle
// (1/sr) unless said otherwise.
#pragma once

#include "light/light.h"
#include "transport/prepared_scene.h"
#include "transport/vertex.h"

namespace troffer {

// A connection under the assumption that nothing is in the way, and the shadow ray that tests this.
struct LightConnection {
  Ray shadow_ray;       // t_max = 1; ends just before the light, infinite for lights at infinity
  Rgb value;            // f |cos| × radiance of the light
  float pdf_light = 0;  // density of the point per solid angle, given the light; 1 for delta lights
  float pdf_bsdf = 0;   // density with which BSDF sampling finds the point; 0 for delta lights
};

// Returns the shadow ray from a surface to a point of a source. `normal` is the source's unit
// normal towards the surface. t_max = 1 ends the ray just before the source.
Ray shadow_ray_to(const Surface& s, const Vec3& point, const Vec3& normal);

// Returns the shadow ray to a sample of a light of any kind.
Ray shadow_ray_to(const Surface& s, const LightSample& light);

// Connects v with a sample of a light. Returns false if no light can arrive.
bool connect(const Vertex& v, const Bsdf& bsdf, const LightSample& light, LightConnection& out);

// Returns the density per solid angle with which sample(), given `light`, picks the point that a
// ray from `from` meets at vertex v.
float pdf_of_hit(const PreparedScene& scene, const LightPrimitive& light, const Vec3& from,
                 const Vec3& direction, const Vertex& v);

// Returns the light primitive at a surface point, or no_primitive.
int32_t primitive_at(const PreparedScene& scene, const Surface& surface);

// Returns the radiance that the surface at v emits towards the viewer.
Rgb emission_at(const PreparedScene& scene, const Vertex& v);

// Returns the power heuristic's weight (exponent 2) for one sample of each technique. For several
// samples, multiply each density by its sample count. (Veach 1997, Eq. 9.13)
inline float power_heuristic(float pdf, float other) {
  if (pdf == 0) return 0;
  // division first: squares of large densities would overflow to inf / inf
  const float ratio = other / pdf;
  return 1 / (1 + ratio * ratio);
}

}  // namespace troffer
