// Polar curves of measured luminaires, as drawings.
#pragma once

#include <string>

#include "scene/light_web.h"

namespace troffer {

// Draws the intensities in the planes C0 to C180 (solid, red) and C90 to C270 (dashed, blue), the
// nadir downwards, over rings of equal intensity, to an .svg (with numbers) or a .png. UsageError
// for other endings.
void write_polar_curve(const std::string& path, const LightWeb& web);

}  // namespace troffer
