// Draws polar intensity curves of photometric webs, for `troffer info --polar`.
#pragma once

#include <string>

#include "scene/light_web.h"

namespace troffer {

// Draws the intensities in the planes C0-C180 (solid, red) and C90-C270 (dashed, blue), the nadir
// downward, over rings of equal intensity. Writes .svg (with numbers) or .png. Throws UsageError
// for other endings.
void write_polar_curve(const std::string& path, const LightWeb& web);

}  // namespace troffer
