// pbrt's Camera and Film -> a scene's camera.
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

struct PbrtFilm {
  int width = 1280, height = 720;
  // The window of it that is shown, in pixels from the top left: x0 x1 y0 y1.
  std::array<int, 4> window{0, 1280, 0, 720};
  double diagonal_mm = 35;
};
// InputError: resolutions below 1 or above 65536.
PbrtFilm read_pbrt_film(const std::string& type, const PbrtParams& params, WarningLog& warnings);

// The camera that pbrt has under that transform: it looks along +z with +y up and +x to the right
// of the image. Types other than perspective and orthographic are shown as perspective, with a
// warning: the realistic one with the focal length of its lens, which is looked up in `folder`. Its
// position counts from `origin`. InputError: a transform without inverse, angles and lenses that
// cannot be.
Camera read_pbrt_camera(const std::string& type, const PbrtParams& params,
                        const Affine& camera_from_world, const Vec3d& origin, const PbrtFilm& film,
                        const std::string& folder, WarningLog& warnings);

}  // namespace troffer
