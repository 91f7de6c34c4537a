// Spectra reduced to linear sRGB. The importers of pbrt and Mitsuba use it for spectral colours,
// named illuminants, metals and glasses. Wavelengths are in nm.
//
// References: [1] Wyman, Sloan & Shirley, "Simple Analytic Approximations to the CIE XYZ Color
//   Matching Functions", JCGT 2(2), 2013.
//   [2] CIE 15:2004, "Colorimetry" (chromaticities of the standard illuminants).
//   [3] pbrt-v4 Input File Format, pbrt.org/fileformat-v4 (names of spectra).
//   [4] Palik (ed.), "Handbook of Optical Constants of Solids", Academic Press, 1985 and 1991.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "base/rgb.h"

namespace troffer {

// Piecewise linear between samples of ascending wavelength; zero outside.
struct SampledSpectrum {
  std::vector<double> wavelengths_nm;
  std::vector<double> values;
};

constexpr uint64_t max_spectrum_file_bytes = uint64_t(1) << 24;
constexpr double sodium_nm = 587.6;  // the line at which single indices of refraction are stated

// Returns the value at a wavelength; 0 outside the samples.
double value_at(const SampledSpectrum& spectrum, double wavelength_nm);

// Returns the colour of a surface of that spectral reflectance under equal-energy light, relative
// to a perfect diffuser. A flat spectrum of value v gives (v, v, v). Never negative.
Rgb reflectance_from_spectrum(const SampledSpectrum& spectrum);

// Returns the colour of that spectral radiance, scaled to luminance 1 (pbrt's rule for lights);
// black if the spectrum is dark. Never negative.
Rgb emission_from_spectrum(const SampledSpectrum& spectrum);

// Returns the colour of a black body, scaled to luminance 1. `kelvin` must be positive.
Rgb blackbody_emission(double kelvin);

// Returns the colour of pbrt's named illuminants ("stdillum-D65", "illum-acesD60", …), scaled to
// luminance 1.
std::optional<Rgb> named_illuminant(std::string_view name);

// Returns the index or extinction of "metal-Cu-eta", "metal-Au-k", …, at the wavelengths of
// conductor_from_spectrum.
std::optional<Rgb> named_metal(std::string_view name);
// Returns the index of refraction of "glass-BK7", … at 587.6 nm.
std::optional<float> named_glass(std::string_view name);

// Samples an index of refraction or an extinction at the wavelengths that stand for r, g and b:
// 630, 532, 465 nm.
Rgb conductor_from_spectrum(const SampledSpectrum& spectrum);

}  // namespace troffer
