// pbrt's lights without surface.
//
// References: [1] pbrt-v4 Input File Format, section "Lights", pbrt.org/fileformat-v4.
//   [2] Pharr, Jakob & Humphreys, "Physically Based Rendering", 4th ed., 12.5.3.
#pragma once

#include <optional>
#include <string>

#include "base/transform.h"
#include "import/pbrt/pbrt_params.h"
#include "import/pbrt/pbrt_spectrum.h"
#include "scene/scene.h"

namespace troffer {

// What a LightSource directive says, in a world that counts from the scene's origin: point, spot,
// distant, infinite, goniometric or projection; an image goes to Scene::environments. Nothing, and
// a warning that says why, for other kinds and what cannot be shown. InputError: parameters that
// cannot be used.
std::optional<Light> read_pbrt_light(const std::string& type, const PbrtParams& params,
                                     const Affine& world_from_light,
                                     const PbrtSpectrumContext& context, Scene& scene);

}  // namespace troffer
