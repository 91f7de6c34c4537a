// A source as a bintree samples it: a map from the unit square to the source, and the light from
// there at a vertex. It works for lights of any shape and for bright patches of the radiosity
// solution. The square maps to the surface uniformly by area (source_surface.h). For a sphere it
// maps to the solid angle that the vertex sees, or half of the square would lie on the far side.
// For lights without surface it maps to their directions.
#pragma once

#include "light/light.h"
#include "light/source_surface.h"
#include "radiosity/solution.h"
#include "transport/prepared_scene.h"
#include "transport/surface_scattering.h"
#include "transport/vertex.h"

namespace troffer {

// Light from the point (u,v) of a source at a vertex, without occlusion.
struct TreeSourceSample {
  Rgb value;  // radiance towards the viewer per unit area of the square
  Ray shadow_ray;
};

// A light, or a patch of the radiosity solution.
class TreeSource {
 public:
  TreeSource(const PreparedScene& scene, uint32_t light);
  // A patch emits the radiance that it has shot.
  TreeSource(const PreparedScene& scene, const RadiositySolution& solution, uint32_t patch);

  bool is_patch() const { return light_ < 0; }
  // True if there is nothing to sample.
  bool is_empty() const {
    return (!(surface_.area() > 0) && sampled_ == no_primitive) || is_black_;
  }
  // True if one ray decides, because the source has one point or direction.
  bool is_delta() const { return is_delta_; }
  // True if all points emit the same radiance in all directions.
  bool is_constant() const { return is_constant_; }
  Rgb radiance() const { return radiance_; }  // where is_constant

  // True if the unoccluded irradiance at a vertex is known exactly, in W/m² or lx. It counts what
  // lies above the horizon of the shading normal.
  bool has_exact_irradiance() const { return is_constant_ && is_convex_; }
  Rgb exact_irradiance(const PreparedScene& scene, const Vertex& v) const;

  // Computes the light from (u,v) and its shadow ray. Returns false if no light can arrive.
  // light_rays: number of light rays in the power heuristic against spawned rays, which also sample
  // the specular part.
  bool sample(const PreparedScene& scene, const Vec2& uv, const Vertex& v,
              const SurfaceScattering& s, float light_rays, TreeSourceSample& out) const;

  // Returns the density per solid angle of `direction` from `from` under uniform (u,v), for a ray
  // that hit this light at v.
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
  Vec3 round_centre_;       // centre of the sphere that a patch lies on
  float round_radius_ = 0;  // 0: the patch is not part of a sphere
};

}  // namespace troffer
