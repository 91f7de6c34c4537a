// Parameters of Mitsuba's plugins: numbers, vectors, transforms and colours.
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

// The parameter of that name, null where there is none. Marks it as used.
const MitsubaNode* find_parameter(const MitsubaNode& plugin, std::string_view name);
// The first of several names that is there.
const MitsubaNode* find_parameter(const MitsubaNode& plugin,
                                  std::initializer_list<std::string_view> names);

// Values of parameters, or `fallback` where they are not there. InputError at the parameter's
// place: text that is no such value. Numbers are finite.
double get_number(const MitsubaNode& plugin, std::string_view name, double fallback);
int get_integer(const MitsubaNode& plugin, std::string_view name, int fallback);
bool get_flag(const MitsubaNode& plugin, std::string_view name, bool fallback);
std::string get_text(const MitsubaNode& plugin, std::string_view name, const std::string& fallback);
std::optional<Vec3d> get_vector(const MitsubaNode& plugin, std::string_view name);
// A <transform>; the identity where it is not there.
Affine get_transform(const MitsubaNode& plugin, std::string_view name);

// Numbers separated by commas or blanks.
std::vector<double> numbers_of(const MitsubaNode& node, const std::string& text);

// Value of an <rgb>, <srgb>, <spectrum>, <xyz>, <blackbody> or number says, in linear sRGB. Not
// below 0. Files of spectra are looked up in `folder`.
Rgb color_of(const MitsubaNode& node, const std::string& folder, WarningLog& warnings,
             SpectrumUse use);
// Emission of a black body. InputError at the node's place: a temperature that cannot be.
Rgb blackbody_color(const MitsubaNode& node, double kelvin);
// InputError: lists of different lengths, or wavelengths that do not ascend.
SampledSpectrum spectrum_from_pairs(const MitsubaNode& node, const std::vector<double>& at,
                                    const std::vector<double>& values);
// Whether a parameter is such a colour rather than a texture or another plugin.
bool is_color(const MitsubaNode& node);

// An index or extinction of a metal at three wavelengths: numbers as they are, spectra looked up.
Rgb metal_index_of(const MitsubaNode& node, const std::string& folder);

// An index of refraction: a number or the name of a material. InputError: unknown names.
double index_of_refraction(const MitsubaNode& plugin, std::string_view name,
                           const std::string& fallback);

// Names every parameter that nobody has asked for in a warning.
void warn_of_unused(const MitsubaNode& plugin, WarningLog& warnings);

}  // namespace troffer
