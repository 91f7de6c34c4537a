// Shooter of the radiosity solution: a light, or a patch with the relative radiosity of its
// elements. form_factors.h computes the transfer from it to sample points. Areas are in m²;
// radiance has the scene's unit.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "light/light_primitive.h"
#include "radiosity/meshing.h"

namespace troffer {

// Pieces with the radiance (mean_radiance) that they send. Points may lie on a sphere that the
// pieces approximate.
struct Shooter {
  std::vector<LightPrimitive> pieces;  // may point into the mesh or the scene's LightPrimitives
  std::vector<double> area_sums;       // prefix sums, m²
  Vec3 round_centre;                   // as in Sheet
  float round_radius = 0;
  float offset = 0;      // metres; rays end this far in front
  bool is_exact = true;  // false: disc approximation
  // Sample points of the patch and the radiance at each, relative to the mean. Empty for uniform
  // radiance.
  std::span<const ElementPoint> parts;
  std::vector<float> share;
  float area() const { return area_sums.empty() ? 0.0f : float(area_sums.back()); }
};

constexpr size_t max_exact_pieces = 24;

// Returns the shooter of a light; it has no pieces if the light has no surface.
Shooter light_shooter(const LightPrimitives& primitives, uint32_t light);
// Returns the shooter of a patch whose pieces send `radiance`.
Shooter patch_shooter(const RadiosityMesh& mesh, uint32_t patch, Rgb radiance);
// Sets parts and shares from the luminance that each point of the patch sends, in any unit. Nearly
// uniform patches keep none.
void set_parts(Shooter& shooter, const RadiosityMesh& mesh, uint32_t patch,
               std::span<const float> luminances);

// Returns a point of a piece, uniform by area.
Vec3 point_on(const LightPrimitive& p, const Vec2& u);
// Returns the index of the part nearest to `point`; 0 if there are none.
size_t nearest_part(std::span<const ElementPoint> parts, const Vec3& point);
// Returns the radiance at a point of the shooter relative to the mean: that of the nearest part, or
// 1 without parts.
float share_at(const Shooter& s, const Vec3& point);

}  // namespace troffer
