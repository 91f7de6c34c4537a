// Materials of which each place is partly one, partly another.
#pragma once

#include "scene/scene.h"

namespace troffer {

// From one colour to the other by a share, as a texture where any of the three is one.
ColorInput blend(Scene& scene, const ColorInput& first, const ColorInput& second,
                 const FloatInput& share);

// Whether two colours are all there is to it: what it sends back and what it lets through.
bool is_plain_diffuse(const Material& m);
// What of the light comes through such a one.
ColorInput transmitted(const Material& m);
// Sets both colours of such a one, as they are.
void set_diffuse(Material& m, const ColorInput& reflected, const ColorInput& through);

// Makes `first` what it and the share of `second` are together: exact. False, and nothing changes,
// where one of them is not plainly diffuse.
bool blend_diffuse(Scene& scene, Material& first, const Material& second, const FloatInput& share);

// Mean over the unit square.
float mean_of(const std::vector<Texture>& textures, const FloatInput& input);

}  // namespace troffer
