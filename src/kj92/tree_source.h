// A source as a bintree samples it: the unit square laid over it, and what light a point of the
// square sends to a vertex.
//
// Lights of any shape, and bright patches of the radiosity solution. The square is laid over the
// surface by area (source_surface.h); over a sphere by the solid angle of what the vertex sees of
// it, or half of the square would lie on the far side; lights without surface have it laid over the
// directions from which they shine.
#pragma once

#include "light/light.h"
#include "light/source_surface.h"
#include "radiosity/solution.h"
#include "transport/prepared_scene.h"
#include "transport/surface_scattering.h"
#include "transport/vertex.h"

namespace troffer {

// What the point (u,v) of a source sends on at a vertex if nothing is in the way.
struct TreeSourceSample {
  Rgb value;  // radiance towards the viewer per unit of the square
  Ray shadow_ray;
};

class TreeSource {
 public:
  TreeSource(const PreparedScene& scene, uint32_t light);
  // `patch` sends the radiance that it has shot.
  TreeSource(const PreparedScene& scene, const RadiositySolution& solution, uint32_t patch);

  bool is_patch() const { return light_ < 0; }
  // Nothing to sample.
  bool is_empty() const {
    return (!(surface_.area() > 0) && sampled_ == no_primitive) || is_black_;
  }
  // All points are one: a ray tells all.
  bool is_delta() const { return is_delta_; }
  // All points send the same radiance in all directions.
  bool is_constant() const { return is_constant_; }
  Rgb radiance() const { return radiance_; }  // where is_constant

  // The unoccluded irradiance at a vertex is known exactly, W/m² or lx, for the shading normal:
  // what is above that horizon.
  bool has_exact_irradiance() const { return is_constant_ && is_convex_; }
  Rgb exact_irradiance(const PreparedScene& scene, const Vertex& v) const;

  // False where nothing can arrive: then no ray is needed. light_rays: the number of rays with
  // which the specular part, which spawned rays sample too, reckons (power heuristic).
  bool sample(const PreparedScene& scene, const Vec2& uv, const Vertex& v,
              const SurfaceScattering& s, float light_rays, TreeSourceSample& out) const;

  // Density per solid angle with which uniform (u,v) choose the direction from `from` in which a
  // ray has run into this light at v.
  float pdf_of_hit(const PreparedScene& scene, const Vec3& from, const Vec3& direction,
                   const Vertex& v) const;

 private:
  bool point_towards(const PreparedScene& scene, const Vec2& uv, const Vec3& x,
                     LightSample& out) const;

  SourceSurface surface_;
  int32_t light_ = -1;
  int32_t sampled_ = no_primitive;  // the light primitive of a sphere or a light without surface
  Rgb radiance_;
  bool is_constant_ = true, is_convex_ = true, is_two_sided_ = false, is_black_ = false,
       is_delta_ = false;
  Vec3 round_centre_;       // of the sphere on which a patch lies …
  float round_radius_ = 0;  // … or 0
};

}  // namespace troffer
