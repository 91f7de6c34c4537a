// What shoots in the radiosity preprocessing: a light, or a patch with what its elements hold.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "light/light_primitive.h"
#include "radiosity/meshing.h"

namespace troffer {

// What shoots. The pieces' mean_radiance is what they send; points may lie on a sphere that
// the pieces only approximate.
struct Shooter {
  std::vector<LightPrimitive> pieces;  // may point into the mesh or the scene's LightPrimitives
  std::vector<double> area_sums;       // running sums, m²
  Vec3 round_centre;                   // as in Sheet
  float round_radius = 0;
  float offset = 0;      // metres: rays end this much in front
  bool is_exact = true;  // else disc approximation
  // What parts of a patch send, relative to its mean: at these sample points of it, `share` each.
  // Empty: the same everywhere.
  std::span<const ElementPoint> parts;
  std::vector<float> share;
  float area() const { return area_sums.empty() ? 0.0f : float(area_sums.back()); }
};

constexpr size_t max_exact_pieces = 24;

// Without pieces where the light has no surface.
Shooter light_shooter(const LightPrimitives& primitives, uint32_t light);
// Its pieces send `radiance`.
Shooter patch_shooter(const RadiosityMesh& mesh, uint32_t patch, Rgb radiance);
// Sets parts and shares from the luminance that each point of the patch sends, in any unit.
void set_parts(Shooter& shooter, const RadiosityMesh& mesh, uint32_t patch,
               std::span<const float> luminances);

// A point of a piece, uniform by area; round pieces are not meant.
Vec3 point_on(const LightPrimitive& p, const Vec2& u);
// The one of the points that is nearest, by number; 0 if there are none.
size_t nearest_part(std::span<const ElementPoint> parts, const Vec3& point);
// What the part of the shooter at a point sends, relative to the mean: that of the part whose
// middle is nearest. 1 where there are no parts.
float share_at(const Shooter& s, const Vec3& point);

}  // namespace troffer
