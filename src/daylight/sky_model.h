// Luminance distributions of skies, and illuminance by sky and sun. sky_lights.h uses them.
// Irradiances are in W/m² of all wavelengths, illuminances in lx.
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

// Returns one of the 15 standard general skies [1, table 1]; type is in [1, 15].
SkyShape cie_sky(int type);
// Returns a sky of uniform luminance.
inline SkyShape uniform_sky() {
  return {};
}

// Returns the horizontal illuminance of the sky for a relative luminance formula without scale,
// with the sun at the given zenith angle. Quadrature error below 2e-5.
double horizontal_integral(const SkyShape& shape, double sun_zenith_rad);

struct PerezSky {
  SkyShape shape;
  double diffuse_lx = 0;  // on a horizontal plane
  double direct_lx = 0;   // on a plane that faces the sun
};
// Returns sky and sun from the irradiances of all wavelengths [2, 3] in W/m²: direct on a plane
// facing the sun, diffuse on a horizontal plane. They must not both be 0, and the zenith angle must
// be below pi/2. Assumes 2 cm of precipitable water. Clearness and brightness are clamped to the
// model's range.
PerezSky perez_sky(double direct_normal, double diffuse_horizontal, double sun_zenith_rad,
                   double sun_distance_au);

struct Irradiance {
  double direct_normal = 0, diffuse_horizontal = 0;  // W/m² of all wavelengths
};
// Returns the irradiances under a cloudless sky with a Linke turbidity of 1 to 10 [5]: the ratio of
// its extinction to that of clean dry air. The sun must be above the horizon.
Irradiance clear_irradiance(double linke_turbidity, double altitude_deg, double sun_distance_au);

// Return the typical illuminance for a type of sky (1 to 5 overcast, 6 to 10 partly cloudy, 11 to
// 15 clear) and the sun's altitude [4]: diffuse on a horizontal plane, direct on a plane facing the
// sun.
double typical_diffuse_lx(int cie_type, double altitude_deg);
double typical_direct_lx(int cie_type, double altitude_deg, double sun_distance_au);

}  // namespace troffer
