// Mixtures of two materials by a share, per place on the surface. The importers of pbrt and Mitsuba
// use it for mix and blend materials where the mixture is exactly one diffuse material.
#pragma once

#include "scene/scene.h"

namespace troffer {

// Returns the mixture of two colours; `share` is the weight of `second`. Adds a texture to the
// scene if any of the three is one.
ColorInput blend(Scene& scene, const ColorInput& first, const ColorInput& second,
                 const FloatInput& share);

// True if base colour and diffuse transmission describe the material fully. The functions below
// require such materials.
bool is_plain_diffuse(const Material& m);
// Returns the diffusely transmitted share of light.
ColorInput transmitted(const Material& m);
// Sets the reflected and the transmitted colour.
void set_diffuse(Material& m, const ColorInput& reflected, const ColorInput& through);

// Replaces `first` by its mixture with `second`, exactly. Returns false, and changes nothing, if
// one of them is not plainly diffuse.
bool blend_diffuse(Scene& scene, Material& first, const Material& second, const FloatInput& share);

// Returns the mean of the input over the unit square of (u,v), from 16 × 16 points.
float mean_of(const std::vector<Texture>& textures, const FloatInput& input);

}  // namespace troffer
