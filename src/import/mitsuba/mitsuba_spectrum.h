// Spectra reduced to linear sRGB by the rules of Mitsuba's rgb modes, and its named metals.
//
// References: [1] W. Jakob et al., "Mitsuba 3 documentation: Spectra, Variants"; the reduction of
//   lists of wavelengths and values is that of its spectrum_list_to_srgb().
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "base/rgb.h"
#include "import/spectra.h"

namespace troffer {

// The use of a spectrum.
enum class SpectrumUse : uint8_t {
  emission,     // radiance per nanometre: its mean over the observer's luminance curve is the
                // luminance
  reflectance,  // lit by D65, so that a flat spectrum is grey; within [0,1]
  factor,       // the same without an upper bound: indices of refraction, absorption
};

// Sampled spectra, linear between samples and 0 outside them. Not below 0.
Rgb mitsuba_color(const SampledSpectrum& spectrum, SpectrumUse use);

// One value for all wavelengths: sources take the colour of equal-energy light.
Rgb mitsuba_color(double value, SpectrumUse use);

// Planck's law in W/(m² sr nm), as emission. kelvin > 0.
Rgb mitsuba_blackbody(double kelvin);

struct MetalIndices {
  Rgb eta, k;
};
// "Al", "a-C", "Cu_palik" …; nothing for other names.
std::optional<MetalIndices> mitsuba_metal(std::string_view name);

}  // namespace troffer
