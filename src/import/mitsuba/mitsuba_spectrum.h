// Reduces spectra to linear sRGB by the rules of Mitsuba's rgb modes, and lists its named metals.
// Used by the readers of textures, bsdfs and values.
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

// Purpose of a spectrum; it decides the rule of the reduction.
enum class SpectrumUse : uint8_t {
  emission,     // radiance per nm; its mean over the luminance curve is the luminance
  reflectance,  // lit by D65, so that a flat spectrum is grey; within [0,1]
  factor,       // as reflectance, without an upper bound: indices of refraction, absorption
};

// Colour of a sampled spectrum, linear between samples and 0 outside them. Never negative.
Rgb mitsuba_color(const SampledSpectrum& spectrum, SpectrumUse use);

// Colour of a constant spectrum. Emission takes the colour of equal-energy light.
Rgb mitsuba_color(double value, SpectrumUse use);

// Emission by Planck's law, in W/(m² sr nm). Requires kelvin > 0.
Rgb mitsuba_blackbody(double kelvin);

struct MetalIndices {
  Rgb eta, k;
};
// Indices of metals such as "Al", "a-C" and "Cu_palik"; nothing for other names.
std::optional<MetalIndices> mitsuba_metal(std::string_view name);

}  // namespace troffer
