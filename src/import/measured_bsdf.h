// Measured reflection (.bsdf, the tensor files that pbrt's and Mitsuba's `measured` name) -> the
// nearest material that is known: metal of its colour and width, mixed with a diffuse base.
// References: [1] Dupuy & Jakob, "An Adaptive Parameterization for Efficient Material Acquisition
//   and Rendering", SIGGRAPH Asia 2018.
#pragma once

#include <string>

#include "base/log.h"
#include "scene/material.h"

namespace troffer {

// The file `name` within `folder`, or beside the scene. Where it cannot be read, is no such file or
// lies about its own size: grey (0.5), with a warning that says why; else with one that says what
// the material was taken for.
Material measured_material(const std::string& folder, const std::string& name,
                           WarningLog& warnings);

}  // namespace troffer
