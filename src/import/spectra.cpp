#include "import/spectra.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/observer.h"
#include "base/vec.h"

namespace troffer {

namespace {

Rgb not_negative(Rgb c) {
  return {std::max(c.r, 0.0f), std::max(c.g, 0.0f), std::max(c.b, 0.0f)};
}

// Returns the integral of spectrum times matching functions, in steps of 1 nm over the visible
// range.
template <class Spectrum>
Vec3d xyz_integral(const Spectrum& spectrum) {
  Vec3d sum;
  for (int nm = least_visible_nm; nm <= most_visible_nm; ++nm)
    sum += color_matching(nm) * spectrum(double(nm));
  return sum;
}

Rgb with_unit_luminance(const Vec3d& xyz) {
  if (!(xyz.y > 0)) return Rgb{0};
  // Saturated colours lie outside sRGB; clipping them must not change the luminance.
  const Rgb color = not_negative(rgb_from_xyz(xyz / xyz.y));
  return color / luminance(color);
}

Rgb from_chromaticity(double x, double y) {
  return with_unit_luminance({x / y, 1, (1 - x - y) / y});
}

struct Illuminant {
  std::string_view name;
  double x, y;
};
// Chromaticities [2].
constexpr std::array illuminants{
    Illuminant{"stdillum-A", 0.44757, 0.40745},   Illuminant{"stdillum-D50", 0.34567, 0.35850},
    Illuminant{"stdillum-D65", 0.31272, 0.32903}, Illuminant{"illum-acesD60", 0.32168, 0.33767},
    Illuminant{"stdillum-F1", 0.31310, 0.33727},  Illuminant{"stdillum-F2", 0.37208, 0.37529},
    Illuminant{"stdillum-F3", 0.40910, 0.39430},  Illuminant{"stdillum-F4", 0.44018, 0.40329},
    Illuminant{"stdillum-F5", 0.31379, 0.34531},  Illuminant{"stdillum-F6", 0.37790, 0.38835},
    Illuminant{"stdillum-F7", 0.31292, 0.32933},  Illuminant{"stdillum-F8", 0.34588, 0.35875},
    Illuminant{"stdillum-F9", 0.37417, 0.37281},  Illuminant{"stdillum-F10", 0.34609, 0.35986},
    Illuminant{"stdillum-F11", 0.38052, 0.37713}, Illuminant{"stdillum-F12", 0.43695, 0.40441},
};

struct Metal {
  std::string_view name;
  Rgb eta, k;
};
// Measured indices at about 630, 532 and 465 nm, as commonly tabulated per channel. Chromium,
// mercury, iridium, molybdenum, rhodium, tantalum, titanium nitride and tungsten are interpolated
// linearly between rows of [4].
constexpr std::array metals{
    Metal{"Ag", {0.155265f, 0.116723f, 0.138381f}, {4.828343f, 3.122246f, 2.147050f}},
    Metal{"Al", {1.657460f, 0.880369f, 0.521229f}, {9.223869f, 6.269523f, 4.837001f}},
    Metal{"Au", {0.143119f, 0.374957f, 1.442479f}, {3.983160f, 2.385721f, 1.603215f}},
    Metal{"Cu", {0.200438f, 0.924033f, 1.102212f}, {3.912949f, 2.452848f, 2.142188f}},
    Metal{"CuZn", {0.444f, 0.527f, 1.094f}, {3.695f, 2.765f, 1.829f}},
    Metal{"Cr", {3.557f, 2.98f, 2.126f}, {4.362f, 4.45f, 4.302f}},
    Metal{"Hg", {1.965f, 1.461f, 1.131f}, {5.213f, 4.52f, 3.99f}},
    Metal{"Ir", {2.522f, 2.146f, 1.87f}, {4.604f, 4.222f, 3.773f}},
    Metal{"Mo", {3.699f, 3.727f, 3.16f}, {3.539f, 3.663f, 3.543f}},
    Metal{"Rh", {2.145f, 1.927f, 1.816f}, {5.587f, 4.89f, 4.51f}},
    Metal{"Ta", {1.75f, 2.598f, 2.827f}, {2.067f, 1.879f, 2.06f}},
    Metal{"TiN", {1.344f, 1.235f, 1.402f}, {2.745f, 1.953f, 1.422f}},
    Metal{"W", {3.632f, 3.488f, 3.317f}, {2.909f, 2.72f, 2.577f}},
    Metal{"MgO", {1.735f, 1.740f, 1.746f}, {0, 0, 0}},
    Metal{"TiO2", {2.585f, 2.669f, 2.777f}, {0, 0, 0}},
};

struct Glass {
  std::string_view name;
  float eta;
};
constexpr std::array glasses{
    Glass{"glass-BK7", 1.5168f},   Glass{"glass-BAF10", 1.6700f}, Glass{"glass-FK51A", 1.4866f},
    Glass{"glass-LASF9", 1.8503f}, Glass{"glass-F5", 1.6727f},    Glass{"glass-SF5", 1.6727f},
    Glass{"glass-F10", 1.7283f},   Glass{"glass-SF10", 1.7283f},  Glass{"glass-F11", 1.7847f},
    Glass{"glass-SF11", 1.7847f},
};

}  // namespace

double value_at(const SampledSpectrum& spectrum, double wavelength_nm) {
  const std::vector<double>& x = spectrum.wavelengths_nm;
  if (x.empty() || !(wavelength_nm >= x.front() && wavelength_nm <= x.back())) return 0;
  const auto above = std::upper_bound(x.begin(), x.end(), wavelength_nm);
  if (above == x.end()) return spectrum.values.back();
  const auto i = size_t(above - x.begin());  // x[i - 1] <= wavelength < x[i]
  const double t = (wavelength_nm - x[i - 1]) / (x[i] - x[i - 1]);
  return lerp(spectrum.values[i - 1], spectrum.values[i], t);
}

Rgb reflectance_from_spectrum(const SampledSpectrum& spectrum) {
  const auto value = [&](double nm) { return value_at(spectrum, nm); };
  // Division by the perfect diffuser's colour, per channel, maps equal-energy white to sRGB's
  // white.
  const Rgb white = rgb_from_xyz(xyz_integral([](double) { return 1.0; }));
  return not_negative(rgb_from_xyz(xyz_integral(value)) / white);
}

Rgb emission_from_spectrum(const SampledSpectrum& spectrum) {
  return with_unit_luminance(xyz_integral([&](double nm) { return value_at(spectrum, nm); }));
}

Rgb blackbody_emission(double kelvin) {
  // Planck's law up to a constant factor, relative to 560 nm so that low temperatures do not
  // underflow: (560/x)^5 (e^(c/560) - 1) / (e^(c/x) - 1) with c = hc/(k T) in nm.
  const double c = 1.438776877e7 / std::max(kelvin, 100.0);
  return with_unit_luminance(xyz_integral([&](double nm) {
    return std::pow(560 / nm, 5) * std::exp(c / 560 - c / nm) * -std::expm1(-c / 560) /
           -std::expm1(-c / nm);
  }));
}

std::optional<Rgb> named_illuminant(std::string_view name) {
  for (const Illuminant& row : illuminants)
    if (row.name == name) return from_chromaticity(row.x, row.y);
  return std::nullopt;
}

std::optional<Rgb> named_metal(std::string_view name) {
  if (!name.starts_with("metal-")) return std::nullopt;
  name.remove_prefix(6);
  for (const Metal& row : metals) {
    if (!name.starts_with(row.name)) continue;
    const std::string_view rest = name.substr(row.name.size());
    if (rest == "-eta") return row.eta;
    if (rest == "-k") return row.k;
  }
  return std::nullopt;
}

std::optional<float> named_glass(std::string_view name) {
  for (const Glass& row : glasses)
    if (row.name == name) return row.eta;
  return std::nullopt;
}

Rgb conductor_from_spectrum(const SampledSpectrum& spectrum) {
  const auto at = [&](double nm) {
    if (spectrum.wavelengths_nm.empty()) return 0.0f;
    return float(value_at(
        spectrum, std::clamp(nm, spectrum.wavelengths_nm.front(), spectrum.wavelengths_nm.back())));
  };
  return {at(630), at(532), at(465)};
}

}  // namespace troffer
