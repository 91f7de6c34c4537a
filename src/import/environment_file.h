// Picture files -> images of what lies beyond the scene.
#pragma once

#include <string>

#include "base/log.h"
#include "scene/environment_map.h"

namespace troffer {

// EXR, HDR, PFM, PNG or JPEG (made linear). A square one is pbrt's equal-area map, any other covers
// all directions by azimuth and height (lat_long). What is not a number or negative counts as
// black, what is infinite as the largest value that half floats hold; both are warnings. Images of
// more than 8 Mi texels are averaged down. InputError{path, 0, 0, what}: files that cannot be used.
EnvironmentMap read_environment(const std::string& path, WarningLog& warnings);

// Mean cosine-weighted radiance times pi of the image's upper half (z > 0): the irradiance of a
// horizontal plane.
Rgb irradiance_from_above(const EnvironmentMap& map);

}  // namespace troffer
