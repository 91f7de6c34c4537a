// Converts spectral parameters (rgb, spectrum, blackbody) of pbrt files to linear sRGB. Used by the
// readers of materials, textures and lights. All functions throw InputError, at the parameter's
// place, for unusable values.
#pragma once

#include <string>

#include "base/log.h"
#include "base/rgb.h"
#include "import/pbrt/pbrt_params.h"

namespace troffer {

// Folder of the spectrum files, and the log for warnings.
struct PbrtSpectrumContext {
  const std::string& folder;
  WarningLog& warnings;
};

// Reflectance. Values outside [0,1] are clamped with a warning.
Rgb reflectance_value(const PbrtParam& param, const PbrtSpectrumContext& context);
// A factor of any size (constant textures, scales). Negative values become 0 with a warning.
Rgb factor_value(const PbrtParam& param, const PbrtSpectrumContext& context);
// Radiance of a light. Spectra and black bodies are scaled to luminance 1.
Rgb emission_value(const PbrtParam& param, const PbrtSpectrumContext& context);
// One part (eta or k) of a metal's complex index of refraction.
Rgb conductor_value(const PbrtParam& param, const PbrtSpectrumContext& context);
// Real index of refraction (> 0) at 587.6 nm. Spectra add a warning about dispersion.
float ior_value(const PbrtParam& param, const PbrtSpectrumContext& context);

}  // namespace troffer
