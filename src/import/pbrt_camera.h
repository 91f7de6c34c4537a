// pbrt's Camera and Film -> a scene's camera.
//
// References: [1] pbrt-v4 Input File Format, sections "Cameras" and "Film",
//   pbrt.org/fileformat-v4.
#pragma once

#include <string>

#include "base/transform.h"
#include "import/pbrt_params.h"
#include "scene/scene.h"

namespace troffer {

struct PbrtFilm {
  int width = 1280, height = 720;
};
// InputError: resolutions below 1 or above 65536.
PbrtFilm read_pbrt_film(const std::string& type, const PbrtParams& params, WarningLog& warnings);

// The camera that pbrt has under that transform: it looks along +z with +y up and +x to the right
// of the image. Types other than perspective and orthographic are shown as perspective, with a
// warning. Its position counts from `origin`. InputError: a transform without inverse, angles and
// lenses that cannot be.
Camera read_pbrt_camera(const std::string& type, const PbrtParams& params,
                        const Affine& camera_from_world, const Vec3d& origin, const PbrtFilm& film,
                        WarningLog& warnings);

}  // namespace troffer
