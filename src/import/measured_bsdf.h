// Measured reflection: the tensor files (.bsdf) that materials `measured` of pbrt and Mitsuba name.
// They are approximated by metal of the measured mean colour and lobe width, mixed with a diffuse
// base.
// References: [1] Dupuy & Jakob, "An Adaptive Parameterization for Efficient Material Acquisition
//   and Rendering", SIGGRAPH Asia 2018.
#pragma once

#include <string>

#include "base/log.h"
#include "scene/material.h"

namespace troffer {

// Returns the material of file `name` within `folder`, or beside the scene, and warns of the
// approximation. If the file cannot be read, is of another kind, or its fields exceed it, returns
// diffuse grey (0.5) with a warning that gives the reason.
Material measured_material(const std::string& folder, const std::string& name,
                           WarningLog& warnings);

}  // namespace troffer
