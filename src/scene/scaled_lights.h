// Scales the lights of a scene, for dimmers. Geometry and light indices are unchanged. Used by the
// view's dimmers.
#pragma once

#include <span>

#include "scene/scene.h"

namespace troffer {

// Multiplies the emission of scene.lights[i] by factors[i], channel by channel. A factor of 0
// turns a light off. One factor per light is required (CHECK).
Scene with_scaled_lights(Scene scene, std::span<const Rgb> factors);

}  // namespace troffer
