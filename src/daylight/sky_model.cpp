#include "daylight/sky_model.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/units.h"
#include "light/sky_light.h"

namespace troffer {

namespace {

struct Pair {
  float first, second;
};
struct Triple {
  float c, d, e;
};

// [1, table 1]: gradations I to VI (a, b), indicatrices 1 to 6 (c, d, e).
constexpr std::array<Pair, 6> gradations{
    {{4, -0.7f}, {1.1f, -0.8f}, {0, -1}, {-1, -0.55f}, {-1, -0.32f}, {-1, -0.15f}}};
constexpr std::array<Triple, 6> indicatrices{{{0, -1, 0},
                                              {2, -1.5f, 0.15f},
                                              {5, -2.5f, 0.30f},
                                              {10, -3, 0.45f},
                                              {16, -3, 0.30f},
                                              {24, -2.8f, 0.15f}}};
struct Type {
  size_t gradation, indicatrix;  // from 1
};
constexpr std::array<Type, 15> types{{{1, 1},
                                      {1, 2},
                                      {2, 1},
                                      {2, 2},
                                      {3, 1},
                                      {3, 2},
                                      {3, 3},
                                      {3, 4},
                                      {4, 2},
                                      {4, 3},
                                      {4, 4},
                                      {5, 4},
                                      {5, 5},
                                      {6, 5},
                                      {6, 6}}};

using Row = std::array<double, 4>;
// [2, table 1]: a, b, c, d, e, each x1 + x2 Z + delta (x3 + x4 Z), by clearness.
constexpr std::array<std::array<Row, 5>, 8> perez_table{{
    {{{1.3525, -0.2576, -0.2690, -1.4366},
      {-0.7670, 0.0007, 1.2734, -0.1233},
      {2.8000, 0.6004, 1.2375, 1.0000},
      {1.8734, 0.6297, 0.9738, 0.2809},
      {0.0356, -0.1246, -0.5718, 0.9938}}},
    {{{-1.2219, -0.7730, 1.4148, 1.1016},
      {-0.2054, 0.0367, -3.9128, 0.9156},
      {6.9750, 0.1774, 6.4477, -0.1239},
      {-1.5798, -0.5081, -1.7812, 0.1080},
      {0.2624, 0.0672, -0.2190, -0.4285}}},
    {{{-1.1000, -0.2515, 0.8952, 0.0156},
      {0.2782, -0.1812, -4.5000, 1.1766},
      {24.7219, -13.0812, -37.7000, 34.8438},
      {-5.0000, 1.5218, 3.9229, -2.6204},
      {-0.0156, 0.1597, 0.4199, -0.5562}}},
    {{{-0.5484, -0.6654, -0.2672, 0.7117},
      {0.7234, -0.6219, -5.6812, 2.6297},
      {33.3389, -18.3000, -62.2500, 52.0781},
      {-3.5000, 0.0016, 1.1477, 0.1062},
      {0.4659, -0.3296, -0.0876, -0.0329}}},
    {{{-0.6000, -0.3566, -2.5000, 2.3250},
      {0.2937, 0.0496, -5.6812, 1.8415},
      {21.0000, -4.7656, -21.5906, 7.2492},
      {-3.5000, -0.1554, 1.4062, 0.3988},
      {0.0032, 0.0766, -0.0656, -0.1294}}},
    {{{-1.0156, -0.3670, 1.0078, 1.4051},
      {0.2875, -0.5328, -3.8500, 3.3750},
      {14.0000, -0.9999, -7.1406, 7.5469},
      {-3.4000, -0.1078, -1.0750, 1.5702},
      {-0.0672, 0.4016, 0.3017, -0.4844}}},
    {{{-1.0000, 0.0211, 0.5025, -0.5119},
      {-0.3000, 0.1922, 0.7023, -1.6317},
      {19.0000, -5.0000, 1.2438, -1.9094},
      {-4.0000, 0.0250, 0.3844, 0.2656},
      {1.0468, -0.3788, -2.4517, 1.4656}}},
    {{{-1.0500, 0.0289, 0.4260, 0.3590},
      {-0.3250, 0.1156, 0.7781, 0.0025},
      {31.0625, -14.5000, -46.1148, 55.3750},
      {-7.2312, 0.4050, 13.3500, 0.6234},
      {1.5000, -0.6426, 1.8564, 0.5636}}},
}};
constexpr std::array<double, 7> clearness_bins{1.065, 1.230, 1.500, 1.950, 2.800, 4.500, 6.200};
// [3, table 4]: luminous efficacies, diffuse horizontal and direct normal.
constexpr std::array<Row, 8> diffuse_efficacy{{{97.24, -0.46, 12.00, -8.91},
                                               {107.22, 1.15, 0.59, -3.95},
                                               {104.97, 2.96, -5.53, -8.77},
                                               {102.39, 5.59, -13.95, -13.90},
                                               {100.71, 5.94, -22.75, -23.74},
                                               {106.42, 3.83, -36.15, -28.83},
                                               {141.88, 1.90, -53.24, -14.03},
                                               {152.23, 0.35, -45.27, -7.98}}};
constexpr std::array<Row, 8> direct_efficacy{{{57.20, -4.55, -2.98, 117.12},
                                              {98.99, -3.46, -1.21, 12.38},
                                              {109.83, -4.90, -1.71, -8.81},
                                              {110.34, -5.84, -1.99, -4.56},
                                              {106.36, -3.97, -1.75, -6.16},
                                              {107.19, -1.25, -1.51, -26.73},
                                              {105.75, 0.77, -1.26, -34.44},
                                              {101.18, 1.58, -1.10, -8.29}}};
constexpr double water_cm = 2;
constexpr double solar_constant = 1367;        // W/m² [3]
constexpr double solar_illuminance = 127'500;  // lx [4]

// Returns the relative air mass (Kasten & Young 1989).
double air_mass(double altitude_deg) {
  return 1 / (std::sin(rad_from_deg(altitude_deg)) +
              0.50572 * std::pow(altitude_deg + 6.07995, -1.6364));
}

double at(const Row& x, double z, double delta) {
  return x[0] + x[1] * z + delta * (x[2] + x[3] * z);
}

// Midpoint rule in the squared sine of the zenith angle, in which the cosine weight is uniform, and
// in azimuth. By symmetry half of the azimuths suffice.
double integral_by_points(const SkyShape& shape, double sun_zenith_rad, int n) {
  const double sun_up = std::cos(sun_zenith_rad), sun_along = std::sin(sun_zenith_rad);
  double sum = 0;
  for (int i = 0; i < n; ++i) {
    const double sine2 = (i + 0.5) / n, sine = std::sqrt(sine2), up = std::sqrt(1 - sine2);
    for (int k = 0; k < n; ++k) {
      const double along = sine * std::cos(pi * (k + 0.5) / n);
      sum += relative_luminance(shape, up, up * sun_up + along * sun_along);
    }
  }
  return pi * sum / (double(n) * n);
}

// True if the formula gives light anywhere. A few points suffice, and skies of a whole year ask.
bool gives_light(const SkyShape& shape, double sun_zenith_rad) {
  return integral_by_points(shape, sun_zenith_rad, 24) > 0;
}

}  // namespace

SkyShape cie_sky(int type) {
  const Type t = types.at(size_t(type - 1));
  const Pair g = gradations[t.gradation - 1];
  const Triple i = indicatrices[t.indicatrix - 1];
  SkyShape s;
  s.a = g.first;
  s.b = g.second;
  s.c = i.c;
  s.d = i.d;
  s.e = i.e;
  s.k = float(1 - double(i.c) * std::exp(double(i.d) * pi / 2));
  return s;
}

double horizontal_integral(const SkyShape& shape, double sun_zenith_rad) {
  return integral_by_points(shape, sun_zenith_rad, 400);
}

PerezSky perez_sky(double direct_normal, double diffuse_horizontal, double sun_zenith_rad,
                   double sun_distance_au) {
  const double z = sun_zenith_rad, z3 = 1.041 * z * z * z;
  // Infinite without diffuse light; clamped to the model's clearest sky.
  const double clearness =
      std::clamp((1 + direct_normal / diffuse_horizontal + z3) / (1 + z3), 1.0, 12.0);
  const double extraterrestrial = solar_constant / (sun_distance_au * sun_distance_au);
  const double brightness =
      std::clamp(diffuse_horizontal * air_mass(90 - deg_from_rad(z)) / extraterrestrial, 0.01, 0.6);
  const auto bin =
      size_t(std::upper_bound(clearness_bins.begin(), clearness_bins.end(), clearness) -
             clearness_bins.begin());
  // Dark skies between clear and overcast lie outside the measured data (erratum of [2]).
  const double delta =
      clearness > 1.065 && clearness < 2.8 ? std::max(brightness, 0.2) : brightness;
  const auto& row = perez_table[bin];
  PerezSky sky;
  sky.shape.a = float(at(row[0], z, delta));
  sky.shape.b = float(at(row[1], z, delta));
  sky.shape.e = float(at(row[4], z, delta));
  if (bin == 0) {
    const Row &c = row[2], &d = row[3];
    sky.shape.c = float(std::exp(std::pow(delta * (c[0] + c[1] * z), c[2])) - c[3]);
    sky.shape.d = float(-std::exp(delta * (d[0] + d[1] * z)) + d[2] + delta * d[3]);
  } else {
    sky.shape.c = float(at(row[2], z, delta));
    sky.shape.d = float(at(row[3], z, delta));
  }
  if (!gives_light(sky.shape, z)) sky.shape = uniform_sky();  // outside the measured range
  const Row &f = diffuse_efficacy[bin], &r = direct_efficacy[bin];
  sky.diffuse_lx = diffuse_horizontal *
                   (f[0] + f[1] * water_cm + f[2] * std::cos(z) + f[3] * std::log(brightness));
  sky.direct_lx =
      direct_normal *
      std::max(0.0, r[0] + r[1] * water_cm + r[2] * std::exp(5.73 * z - 5) + r[3] * brightness);
  return sky;
}

Irradiance clear_irradiance(double turbidity, double altitude_deg, double sun_distance_au) {
  const double t = turbidity, m = air_mass(altitude_deg);
  const double s = std::sin(rad_from_deg(altitude_deg));
  const double extraterrestrial = solar_constant / (sun_distance_au * sun_distance_au);
  const double thickness_of_dry_air =
      m <= 20 ? 1 / (6.6296 + m * (1.7513 + m * (-0.1202 + m * (0.0065 - m * 0.00013))))
              : 1 / (10.4 + 0.718 * m);
  // Diffuse transmittance at the zenith, and its dependence on altitude.
  const double at_zenith = -1.5843e-2 + t * (3.0543e-2 + t * 3.797e-4);
  const double a0 = std::max(2.6463e-1 + t * (-6.1581e-2 + t * 3.1408e-3), 2e-3 / at_zenith);
  const double a1 = 2.0402 + t * (1.8945e-2 - t * 1.1161e-2);
  const double a2 = -1.3025 + t * (3.9231e-2 + t * 8.5079e-3);
  return {extraterrestrial * std::exp(-0.8662 * t * m * thickness_of_dry_air),
          extraterrestrial * at_zenith * std::max(a0 + s * (a1 + s * a2), 0.0)};
}

double typical_diffuse_lx(int cie_type, double altitude_deg) {
  const double sine = std::max(0.0, std::sin(rad_from_deg(altitude_deg)));
  if (cie_type <= 5) return 300 + 21'000 * sine;
  if (cie_type <= 10) return 300 + 45'000 * sine;
  return 800 + 15'500 * std::sqrt(sine);
}

double typical_direct_lx(int cie_type, double altitude_deg, double sun_distance_au) {
  if (cie_type <= 5 || !(altitude_deg > 0)) return 0;
  const double extinction = cie_type <= 10 ? 0.80 : 0.21;
  return solar_illuminance / (sun_distance_au * sun_distance_au) *
         std::exp(-extinction * air_mass(altitude_deg));
}

}  // namespace troffer
