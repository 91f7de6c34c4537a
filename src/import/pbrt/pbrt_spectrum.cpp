#include "import/pbrt/pbrt_spectrum.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "import/file.h"
#include "import/spectra.h"

namespace troffer {

namespace {

[[noreturn]] void fail_param(const PbrtParam& param, const std::string& what) {
  fail_at(param.place, "parameter \"" + param.name + "\": " + what);
}

SampledSpectrum from_pairs(const PbrtParam& param, const std::vector<double>& numbers) {
  if (numbers.empty() || numbers.size() % 2 != 0)
    fail_param(param, "a spectrum needs pairs of wavelength and value");
  SampledSpectrum spectrum;
  for (size_t i = 0; i < numbers.size(); i += 2) {
    if (!std::isfinite(numbers[i]) || !std::isfinite(numbers[i + 1]))
      fail_param(param, "a spectrum value is not finite");
    if (i > 0 && !(numbers[i] > numbers[i - 2])) fail_param(param, "wavelengths must ascend");
    spectrum.wavelengths_nm.push_back(numbers[i]);
    spectrum.values.push_back(numbers[i + 1]);
  }
  return spectrum;
}

SampledSpectrum from_file(const PbrtParam& param, const std::string& name,
                          const std::string& folder) {
  const ConfinedPath path = confined_path(folder, name);
  if (!path.is_fine()) fail_param(param, "cannot use '" + name + "': " + path.problem);
  std::string text;
  try {
    text = read_text_file(path.path, max_spectrum_file_bytes);
  } catch (const InputError& error) {
    fail_param(param, "'" + name + "' is neither a known spectrum nor a file that can be read (" +
                          error.reason() + ")");
  }
  PbrtTokenizer tokens(path.path, text);
  std::vector<double> numbers;
  for (PbrtToken token = tokens.next(); token.kind != PbrtTokenKind::end; token = tokens.next()) {
    if (token.kind != PbrtTokenKind::number)
      fail_at(tokens.place(token), "expected a number in a spectrum file");
    numbers.push_back(token.number);
  }
  return from_pairs(param, numbers);
}

const std::string& single_name(const PbrtParam& param) {
  if (param.strings.size() != 1 || !param.numbers.empty())
    fail_param(param, "a spectrum is one name, or pairs of wavelength and value");
  return param.strings[0];
}

SampledSpectrum sampled(const PbrtParam& param, const PbrtSpectrumContext& context) {
  return param.strings.empty() ? from_pairs(param, param.numbers)
                               : from_file(param, single_name(param), context.folder);
}

Rgb rgb_of(const PbrtParam& param) {
  if (param.numbers.size() != 3) fail_param(param, "one rgb triple expected");
  const Rgb c(float(param.numbers[0]), float(param.numbers[1]), float(param.numbers[2]));
  if (!is_finite(c)) fail_param(param, "not finite");
  return c;
}

double single_number(const PbrtParam& param) {
  if (param.numbers.size() != 1 || !std::isfinite(param.numbers[0]))
    fail_param(param, "one finite number expected");
  return param.numbers[0];
}

double kelvin_of(const PbrtParam& param) {
  // A second number is the scale of pbrt-v3 files.
  if (param.numbers.empty() || param.numbers.size() > 2 || !(param.numbers[0] > 0) ||
      !std::isfinite(param.numbers[0]))
    fail_param(param, "one positive temperature in kelvin expected");
  if (param.numbers.size() == 2) fail_param(param, "a temperature with a scale is pbrt-v3 syntax");
  return param.numbers[0];
}

[[noreturn]] void fail_kind(const PbrtParam& param) {
  fail_param(param, std::string("a value of type ") + type_name(param.type) + " cannot stand here");
}

Rgb plain_value(const PbrtParam& param, const PbrtSpectrumContext& context) {
  switch (param.type) {
    case PbrtType::rgb:
      return rgb_of(param);
    case PbrtType::real:
      return Rgb{float(single_number(param))};
    case PbrtType::spectrum:
      // An illuminant counts as white if it is used as a reflectance.
      if (!param.strings.empty() && named_illuminant(single_name(param))) return Rgb{1};
      return reflectance_from_spectrum(sampled(param, context));
    default:
      fail_kind(param);
  }
}

}  // namespace

Rgb reflectance_value(const PbrtParam& param, const PbrtSpectrumContext& context) {
  const Rgb value = plain_value(param, context);
  if (clamp01(value) != value)
    context.warnings.add("parameter \"" + param.name + "\": reflectance outside [0,1] is clamped");
  return clamp01(value);
}

Rgb factor_value(const PbrtParam& param, const PbrtSpectrumContext& context) {
  const Rgb value = plain_value(param, context);
  if (value.r < 0 || value.g < 0 || value.b < 0)
    context.warnings.add("parameter \"" + param.name + "\": negative values are set to 0");
  return {std::max(value.r, 0.0f), std::max(value.g, 0.0f), std::max(value.b, 0.0f)};
}

Rgb emission_value(const PbrtParam& param, const PbrtSpectrumContext& context) {
  switch (param.type) {
    case PbrtType::rgb:
      return factor_value(param, context);
    case PbrtType::blackbody:
      return blackbody_emission(kelvin_of(param));
    case PbrtType::spectrum:
      if (!param.strings.empty()) {
        if (const auto color = named_illuminant(single_name(param))) return *color;
      }
      return emission_from_spectrum(sampled(param, context));
    default:
      fail_kind(param);
  }
}

Rgb conductor_value(const PbrtParam& param, const PbrtSpectrumContext& context) {
  if (param.type == PbrtType::rgb) return factor_value(param, context);
  if (param.type == PbrtType::real) return factor_value(param, context);
  if (param.type != PbrtType::spectrum) fail_kind(param);
  if (!param.strings.empty()) {
    if (const auto value = named_metal(single_name(param))) return *value;
    if (const auto value = named_glass(single_name(param))) return Rgb{*value};
  }
  return conductor_from_spectrum(sampled(param, context));
}

float ior_value(const PbrtParam& param, const PbrtSpectrumContext& context) {
  float ior = 0;
  if (param.type == PbrtType::real || param.type == PbrtType::integer) {
    ior = float(single_number(param));
  } else if (param.type == PbrtType::spectrum) {
    context.warnings.add("dispersion is not simulated: one index of refraction for all colours");
    const auto glass =
        param.strings.empty() ? std::optional<float>() : named_glass(single_name(param));
    if (glass) return *glass;
    const SampledSpectrum spectrum = sampled(param, context);
    ior = float(value_at(spectrum, std::clamp(sodium_nm, spectrum.wavelengths_nm.front(),
                                              spectrum.wavelengths_nm.back())));
  } else {
    fail_kind(param);
  }
  if (!(ior > 0 && ior < 1e6f)) fail_param(param, "an index of refraction must be positive");
  return ior;
}

}  // namespace troffer
