// Converts pbrt's LightSource directives (lights without a surface). Used by PbrtInterpreter. Area
// lights are in pbrt_shape.h.
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

// Reads a LightSource directive: point, spot, distant, infinite, goniometric or projection.
// Positions are relative to the scene's origin. Environment and goniometric images are added to
// Scene::environments, projected images to Scene::textures. Returns nothing, with a warning that
// says why, for other types and for lights that cannot be shown. Throws InputError for unusable
// parameters.
std::optional<Light> read_pbrt_light(const std::string& type, const PbrtParams& params,
                                     const Affine& world_from_light,
                                     const PbrtSpectrumContext& context, Scene& scene);

}  // namespace troffer
