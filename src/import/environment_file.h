// Environment images from files, for `--environment` and for the lights of pbrt and Mitsuba. Texels
// are linear RGB radiance in the file's own units. Memory is limited to 8 Mi texels for each image.
#pragma once

#include <string>

#include "base/log.h"
#include "scene/environment_map.h"

namespace troffer {

// Reads an EXR, HDR, PFM, PNG or JPEG file as linear values. A square image is pbrt's equal-area
// map; any other covers all directions by azimuth and height (lat_long).
// NaN and negative values become 0, infinite ones the image's largest value, at least 65504; both
// with a warning. Averages images of more than 8 Mi texels down.
// Throws InputError{path, 0, 0, what} for files that cannot be used.
EnvironmentMap read_environment(const std::string& path, WarningLog& warnings);

// Returns the irradiance of a horizontal plane by the upper half of the image (z > 0): pi times the
// mean cosine-weighted radiance.
Rgb irradiance_from_above(const EnvironmentMap& map);

}  // namespace troffer
