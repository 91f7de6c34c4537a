// Measured distributions: intensity by direction, and the flux they add up to.
#pragma once

#include "base/vec.h"
#include "scene/light_web.h"

namespace troffer {

// Intensity in the unit direction w of the web's own axes, linear in both angles.
float intensity(const LightWeb& web, const Vec3& w);

// Integral of the intensity over all directions, exactly for what intensity() returns.
double flux(const LightWeb& web);

float largest_intensity(const LightWeb& web);

}  // namespace troffer
