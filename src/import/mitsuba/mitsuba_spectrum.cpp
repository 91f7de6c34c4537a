#include "import/mitsuba/mitsuba_spectrum.h"

#include <algorithm>
#include <cmath>

#include "base/observer.h"

namespace troffer {

namespace {

// Samples from the least visible wavelength to the greatest, both included.
constexpr int spectrum_steps = 1000;
// Integral of the observer's luminance curve (nm), as the mean of these samples times their range.
constexpr double luminance_integral = 106.7502593994140625;

Rgb srgb_of(const Vec3d& c) {
  return {float(3.240479 * c.x - 1.537150 * c.y - 0.498535 * c.z),
          float(-0.969256 * c.x + 1.875991 * c.y + 0.041556 * c.z),
          float(0.055648 * c.x - 0.204043 * c.y + 1.057311 * c.z)};
}

Rgb at_least_black(Rgb c) {
  return {std::max(c.r, 0.0f), std::max(c.g, 0.0f), std::max(c.b, 0.0f)};
}

template <class Spectrum>
Vec3d xyz_of(const Spectrum& spectrum, SpectrumUse use) {
  constexpr double range = most_visible_nm - least_visible_nm;
  Vec3d sum;
  for (int i = 0; i < spectrum_steps; ++i) {
    const double nm = least_visible_nm + range * i / (spectrum_steps - 1);
    const double lit = use == SpectrumUse::emission ? 1.0 : d65_power(nm);
    sum += color_matching(nm) * (spectrum(nm) * lit);
  }
  return sum * (range / (spectrum_steps * luminance_integral));
}

}  // namespace

Rgb mitsuba_color(const SampledSpectrum& spectrum, SpectrumUse use) {
  const Rgb c =
      at_least_black(srgb_of(xyz_of([&](double nm) { return value_at(spectrum, nm); }, use)));
  return use == SpectrumUse::reflectance ? clamp01(c) : c;
}

Rgb mitsuba_color(double value, SpectrumUse use) {
  return use == SpectrumUse::emission ? srgb_of(Vec3d{1} * value) : Rgb{float(value)};
}

Rgb mitsuba_blackbody(double kelvin) {
  constexpr double first = 1.191042972e-16, second = 1.438776877e-2;  // 2 h c², h c / k
  const auto planck = [&](double nm) {
    const double metres = nm * 1e-9;
    return 1e-9 * first / (std::pow(metres, 5) * std::expm1(second / metres / kelvin));
  };
  return at_least_black(srgb_of(xyz_of(planck, SpectrumUse::emission)));
}

}  // namespace troffer
