// Lens files of pbrt's realistic cameras, reduced to a thin lens by paraxial optics. Used by
// read_pbrt_camera.
//
// References: [1] pbrt-v4 Input File Format, "Cameras: realistic";
//   [2] Kolb, Mitchell & Hanrahan, "A Realistic Camera Model for Computer Graphics",
//   SIGGRAPH 1995 (thick lenses, §3.1).
#pragma once

#include <string>

#include "import/pbrt/pbrt_params.h"

namespace troffer {

// Thin lens that is equivalent for paraxial rays; lengths in metres.
struct PbrtLens {
  double focal_length = 0;
  double pupil_radius = 0;  // radius of the entrance pupil
};

// Reads a lens file: curvature radius, thickness behind, index behind and diameter of each surface,
// in millimetres, from the front to the film. A surface of radius 0 is the aperture stop. Its
// diameter is the smaller of `aperture_mm` and the file's. Throws InputError if the file is not
// such a list or the lens does not focus.
PbrtLens read_pbrt_lens(const std::string& path, double aperture_mm);

}  // namespace troffer
