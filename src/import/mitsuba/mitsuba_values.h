// Parameters of Mitsuba's plugins: numbers, vectors, transforms and colours. Used by all readers of
// this folder.
//
// References: [1] W. Jakob et al., "Mitsuba 3 documentation: Scene XML file format";
//   [2] W. Jakob, "Mitsuba 0.6 Documentation", §6 (Scene file format).
#pragma once

#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>

#include "base/rgb.h"
#include "base/transform.h"
#include "import/mitsuba/mitsuba_spectrum.h"
#include "import/mitsuba/mitsuba_tree.h"

namespace troffer {

// Returns the parameter of that name, or null. Marks it as used.
const MitsubaNode* find_parameter(const MitsubaNode& plugin, std::string_view name);
// Returns the first of several names that is present.
const MitsubaNode* find_parameter(const MitsubaNode& plugin,
                                  std::initializer_list<std::string_view> names);

// Values of parameters, or `fallback` if they are missing. Numbers are finite. Throws InputError,
// at the parameter's place, for text that is not such a value.
double get_number(const MitsubaNode& plugin, std::string_view name, double fallback);
int get_integer(const MitsubaNode& plugin, std::string_view name, int fallback);
bool get_flag(const MitsubaNode& plugin, std::string_view name, bool fallback);
std::string get_text(const MitsubaNode& plugin, std::string_view name, const std::string& fallback);
std::optional<Vec3d> get_vector(const MitsubaNode& plugin, std::string_view name);
// Value of a <transform>; the identity if it is missing.
Affine get_transform(const MitsubaNode& plugin, std::string_view name);

// Reads numbers separated by commas, semicolons or blanks.
std::vector<double> numbers_of(const MitsubaNode& node, const std::string& text);

// Value of an <rgb>, <srgb>, <spectrum>, <xyz>, <blackbody> or number, in linear sRGB. Never
// negative. Spectrum files are looked up in `folder`.
Rgb color_of(const MitsubaNode& node, const std::string& folder, WarningLog& warnings,
             SpectrumUse use);
// Emission of a black body. Throws InputError, at the node's place, for impossible temperatures.
Rgb blackbody_color(const MitsubaNode& node, double kelvin);
// Throws InputError for lists of different lengths and for wavelengths that do not ascend.
SampledSpectrum spectrum_from_pairs(const MitsubaNode& node, const std::vector<double>& at,
                                    const std::vector<double>& values);
// True if a parameter is such a colour rather than a texture or another plugin.
bool is_color(const MitsubaNode& node);

// Index or extinction of a metal in linear sRGB. Numbers are used directly, spectra are reduced.
Rgb metal_index_of(const MitsubaNode& node, const std::string& folder);

// Index of refraction, from a number or the name of a material. Throws InputError for unknown
// names.
double index_of_refraction(const MitsubaNode& plugin, std::string_view name,
                           const std::string& fallback);

// Adds a warning for every parameter that has not been read.
void warn_of_unused(const MitsubaNode& plugin, WarningLog& warnings);

}  // namespace troffer
