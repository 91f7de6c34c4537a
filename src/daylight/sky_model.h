// Luminance distributions of skies, and how much light they and the sun bring.
//
// References: [1] CIE S 011/E:2003 (ISO 15469:2004), "Spatial distribution of daylight: CIE
// standard
//   general sky".
//   [2] Perez, Seals & Michalsky, "All-weather model for sky luminance distribution: preliminary
//   configuration and validation", Solar Energy 50(3), 1993, and the erratum in 51(5).
//   [3] Perez, Ineichen, Seals, Michalsky & Stewart, "Modeling daylight availability and irradiance
//   components from direct and global irradiance", Solar Energy 44(5), 1990.
//   [4] IES RP-21-84, "Calculation of daylight availability".
//   [5] Rigollier, Bauer & Wald, "On the clear sky model of the ESRA", Solar Energy 68(1), 2000;
//   Kasten, "The Linke turbidity factor based on improved values of the integral Rayleigh optical
//   thickness", Solar Energy 56(3), 1996.
#pragma once

#include "scene/light.h"

namespace troffer {

constexpr double sun_angular_radius_deg = 0.533 / 2;

// One of the 15 standard general skies [1, table 1]; type within [1, 15].
SkyShape cie_sky(int type);
// Equally bright everywhere.
inline SkyShape even_sky() {
  return {};
}

// What the sky sends to a horizontal plane, relative to a luminance of its formula of 1: for the
// sun at that angle from the zenith. Quadrature; errors under 2e-5.
double horizontal_integral(const SkyShape& shape, double sun_zenith_rad);

struct PerezSky {
  SkyShape shape;
  double diffuse_lx = 0;  // on a horizontal plane
  double direct_lx = 0;   // on a plane that faces the sun
};
// Sky and sun by the irradiances of all wavelengths [2, 3], W/m²: direct on a plane that faces the
// sun, diffuse on a horizontal one, not both 0. The sun's zenith angle is under pi/2. Air holds 2
// cm of water. Clearness and brightness outside the model's range are moved to its ends.
PerezSky perez_sky(double direct_normal, double diffuse_horizontal, double sun_zenith_rad,
                   double sun_distance_au);

struct Irradiance {
  double direct_normal = 0, diffuse_horizontal = 0;  // W/m² of all wavelengths
};
// Under a cloudless sky whose air weakens the sun as `linke_turbidity` (1 to 10) times as much dry
// clean air would [5]; the sun is above the horizon.
Irradiance clear_irradiance(double linke_turbidity, double altitude_deg, double sun_distance_au);

// Illuminance by type of sky (1 to 5 overcast, to 10 partly cloudy, to 15 clear) and the sun's
// altitude [4]: diffuse on a horizontal plane, and direct on one that faces the sun.
double typical_diffuse_lx(int cie_type, double altitude_deg);
double typical_direct_lx(int cie_type, double altitude_deg, double sun_distance_au);

}  // namespace troffer
