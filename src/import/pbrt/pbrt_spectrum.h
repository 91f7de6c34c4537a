// Values of spectrum-like parameters (rgb, spectrum, blackbody) in linear sRGB.
#pragma once

#include <string>

#include "base/log.h"
#include "base/rgb.h"
#include "import/pbrt/pbrt_params.h"

namespace troffer {

// What the readers below need: the folder of spectrum files, and where warnings go.
struct PbrtSpectrumContext {
  const std::string& folder;
  WarningLog& warnings;
};

// All throw InputError at the parameter's place for values that cannot be used.

// Reflectance in [0,1]; what lies outside is clamped with a warning.
Rgb reflectance_value(const PbrtParam& param, const PbrtSpectrumContext& context);
// A factor that may be of any size (constant textures, scales), not below 0.
Rgb factor_value(const PbrtParam& param, const PbrtSpectrumContext& context);
// Radiance of a light. Spectra and black bodies count as shapes only, of luminance 1.
Rgb emission_value(const PbrtParam& param, const PbrtSpectrumContext& context);
// Complex index of a metal, one part of it.
Rgb conductor_value(const PbrtParam& param, const PbrtSpectrumContext& context);
// Real index of refraction (> 0) at 587.6 nm.
float ior_value(const PbrtParam& param, const PbrtSpectrumContext& context);

}  // namespace troffer
