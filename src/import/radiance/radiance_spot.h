// Converts Radiance's spotlights to spots without extent. Used by RadianceSurfaces. A surface of
// radiance L and focal distance f lights receivers in its beam as if it lay f further back: E = L A
// cos θ cos θ_receiver / (d + f)². It becomes a spot in its centre of intensity L A cos θ.
//
// References: [1] "The RADIANCE 5.1 Synthetic Imaging System", §2.1.2 (spotlight).
#pragma once

#include "import/radiance/radiance_material.h"

namespace troffer {

// Size of a surface as seen from far away, in world space.
struct RadianceExtent {
  Vec3d middle;
  Vec3d area;          // flat surfaces: normal times area; 0 for round ones
  double section = 0;  // round surfaces: largest projected area
};
RadianceExtent extent_of_polygon(const std::vector<Vec3d>& corners, const Affine& world,
                                 bool is_inverted);
// Reads ring, sphere, cylinder and cone. Throws InputError, at their place, for a wrong number of
// values.
RadianceExtent extent_of_round(const RadianceModifier& p, bool is_inverted);

// Appends the spot. Appends nothing if the beam leaves a flat surface at its back.
void add_radiance_spot(const RadianceLook& look, const std::string& name,
                       const RadianceExtent& extent, Scene& scene);

}  // namespace troffer
