// pbrt's lens files: what a simple camera that sees the same has.
//
// References: [1] pbrt-v4 Input File Format, "Cameras: realistic"; [2] Kolb, Mitchell & Hanrahan,
// "A
//   Realistic Camera Model for Computer Graphics", SIGGRAPH 1995 (thick lenses, §3.1).
#pragma once

#include <string>

#include "import/pbrt/pbrt_params.h"

namespace troffer {

// Of rays near the axis; metres.
struct PbrtLens {
  double focal_length = 0;
  double pupil_radius = 0;  // of the opening that is seen from the front
};

// Lines of curvature radius, thickness behind, index behind and diameter of each surface, in
// millimetres, from the front to the film; a radius of 0 is the stop, which is open as far as
// `aperture_mm` and the file say. InputError: what is no such list, or does not focus.
PbrtLens read_pbrt_lens(const std::string& path, double aperture_mm);

}  // namespace troffer
