// Converts pbrt's Camera and Film directives to a scene's camera. Used by PbrtInterpreter. Lens
// data of files are in millimetres.
//
// References: [1] pbrt-v4 Input File Format, sections "Cameras" and "Film",
//   pbrt.org/fileformat-v4.
#pragma once

#include <array>
#include <string>

#include "base/transform.h"
#include "import/pbrt/pbrt_params.h"
#include "scene/scene.h"

namespace troffer {

// A Film directive; the defaults are pbrt's.
struct PbrtFilm {
  int width = 1280, height = 720;
  // Shown part of the film, in pixels from the top left: x0 x1 y0 y1.
  std::array<int, 4> window{0, 1280, 0, 720};
  double diagonal_mm = 35;  // sensor diagonal; realistic cameras only
};
// Throws InputError for resolutions below 1 or above 65536.
PbrtFilm read_pbrt_film(const std::string& type, const PbrtParams& params, WarningLog& warnings);

// Returns pbrt's camera under that transform: it looks along +z, with +y up and +x to the right of
// the image. Its position is relative to `origin`. A type other than perspective and orthographic
// becomes a perspective camera, with a warning. A realistic camera keeps the focal length of its
// lens, whose file is looked up in `folder`. Throws InputError for a transform without inverse and
// for impossible angles or lenses.
Camera read_pbrt_camera(const std::string& type, const PbrtParams& params,
                        const Affine& camera_from_world, const Vec3d& origin, const PbrtFilm& film,
                        const std::string& folder, WarningLog& warnings);

}  // namespace troffer
