// Connecting a vertex with a point on a light: what every method that samples sources shares.
#pragma once

#include "light/light.h"
#include "transport/prepared_scene.h"
#include "transport/vertex.h"

namespace troffer {

// An unoccluded connection and the ray that tells whether it is one.
struct LightConnection {
  Ray shadow_ray;       // t_max = 1; ends just before the light, or never
  Rgb value;            // f |cos| × radiance that the light sends
  float pdf_light = 0;  // of the light's point, per solid angle, the light being given; delta: 1
  float pdf_bsdf = 0;   // with which the BSDF's sampling finds this point of the light; delta: 0
};

// The ray from a surface to a point of a source whose unit normal towards the surface is given;
// t_max = 1 stops it just before the source.
Ray shadow_ray_to(const Surface& s, const Vec3& point, const Vec3& normal);

// The same towards a sample of a light, whatever its kind.
Ray shadow_ray_to(const Surface& s, const LightSample& light);

// Connects v with a sample of a light. False where nothing can arrive.
bool connect(const Vertex& v, const Bsdf& bsdf, const LightSample& light, LightConnection& out);

// The density per solid angle, given that `light` is sampled, with which sample() picks the point
// that a ray from `from` meets at vertex v.
float pdf_of_hit(const PreparedScene& scene, const LightPrimitive& light, const Vec3& from,
                 const Vec3& direction, const Vertex& v);

// The light primitive at a vertex, or no_primitive.
int32_t primitive_at(const PreparedScene& scene, const Surface& surface);

// Radiance that the surface at v itself emits towards the viewer.
Rgb emission_at(const PreparedScene& scene, const Vertex& v);

// The power heuristic with exponent 2 for one sample of each technique; multiply densities by
// sample counts for more. (Veach 1997, Eq. 9.13)
inline float power_heuristic(float pdf, float other) {
  if (pdf == 0) return 0;
  const float ratio = other / pdf;  // a quotient cannot overflow into inf / inf
  return 1 / (1 + ratio * ratio);
}

}  // namespace troffer
