// Spectra reduced to linear sRGB.
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

// Piecewise linear between samples of ascending wavelength, zero outside them.
struct SampledSpectrum {
  std::vector<double> wavelengths_nm;
  std::vector<double> values;
};

constexpr uint64_t max_spectrum_file_bytes = uint64_t(1) << 24;
constexpr double sodium_nm = 587.6;  // where single indices of refraction are given

double value_at(const SampledSpectrum& spectrum, double wavelength_nm);

// Colour of a surface of that spectral reflectance under equal-energy light, relative to a perfect
// diffuser: a flat spectrum of value v gives (v, v, v). Not below 0.
Rgb reflectance_from_spectrum(const SampledSpectrum& spectrum);

// Colour of that spectral radiance, scaled to luminance 1 (pbrt's rule for lights); black where
// there is none. Not below 0.
Rgb emission_from_spectrum(const SampledSpectrum& spectrum);

// Colour of a black body of that temperature (kelvin, > 0), luminance 1.
Rgb blackbody_emission(double kelvin);

// Colour, luminance 1, of pbrt's named illuminants ("stdillum-D65", "illum-acesD60" …).
std::optional<Rgb> named_illuminant(std::string_view name);

// "metal-Cu-eta", "metal-Au-k" …: index or extinction at the wavelengths of
// conductor_from_spectrum.
std::optional<Rgb> named_metal(std::string_view name);
// "glass-BK7" …: index of refraction at 587.6 nm.
std::optional<float> named_glass(std::string_view name);

// An index of refraction or an extinction at wavelengths that stand for r, g and b
// (630, 532, 465 nm).
Rgb conductor_from_spectrum(const SampledSpectrum& spectrum);

}  // namespace troffer
