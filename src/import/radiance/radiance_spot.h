// Radiance's spotlights -> spots without extent.
//
// A surface of radiance L lights what lies within its beam as if it lay its focal distance f
// further back: E = L A cos θ cos θ_receiver / (d + f)². It becomes a spot in its middle, of
// intensity L A cos θ.
//
// References: [1] "The RADIANCE 5.1 Synthetic Imaging System", §2.1.2 (spotlight).
#pragma once

#include "import/radiance/radiance_material.h"

namespace troffer {

// A surface as seen from far away, in world space.
struct RadianceExtent {
  Vec3d middle;
  Vec3d area;          // along the normal of flat ones, as long as the area; 0: of round ones …
  double section = 0;  // … the largest area that is seen of them
};
RadianceExtent extent_of_polygon(const std::vector<Vec3d>& corners, const Affine& world,
                                 bool is_inverted);
// Reads ring, sphere, cylinder and cone. InputError at its place: too few numbers.
RadianceExtent extent_of_round(const RadianceModifier& p, bool is_inverted);

// Appends the spot; nothing where the beam leaves a flat surface at its back.
void add_radiance_spot(const RadianceLook& look, const std::string& name,
                       const RadianceExtent& extent, Scene& scene);

}  // namespace troffer
