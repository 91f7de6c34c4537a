// A sky, the ground below it and the sun, as lights of a scene.
#pragma once

#include <optional>

#include "base/vec.h"
#include "scene/scene.h"

namespace troffer {

// World directions; unit, orthogonal. In worlds that mirror (pbrt's own) east is mirrored too.
struct Compass {
  Vec3d east{1, 0, 0}, north{0, 0, -1}, up{0, 1, 0};

  // Azimuth clockwise from north, seen from above; altitude above the horizon.
  Vec3d direction(double azimuth_deg, double altitude_deg) const;
};

// North lies `north_deg` clockwise, seen from above, from -z, or from +y where z (or -z) is up.
Compass make_compass(const Vec3& up, double north_deg, bool is_mirrored);

struct SunRequest {
  double azimuth_deg = 0, altitude_deg = 45;
  double distance_au = 1;
  std::optional<double> direct_lx;  // on a plane that faces it; else what is typical
};

enum class SkyKind { even, cie, perez };

struct SkyRequest {
  SkyKind kind = SkyKind::even;
  int cie_type = 1;                                  // cie
  double direct_normal = 0, diffuse_horizontal = 0;  // perez: W/m² of all wavelengths
  std::optional<double> diffuse_lx;                  // on a horizontal plane; else what is typical
  std::optional<SunRequest> sun;                     // must be above the horizon
  std::optional<double> turbidity;                   // Linke's; of clear types, with a sun
  double ground_reflectance = 0.2;
};

// Whether the sky depends on where the sun stands.
bool needs_sun(const SkyRequest& request);

// Appends the light "sky", and "sun" where there is one that sends anything. Both are white; the
// ground, of that reflectance, shines evenly with what falls on it. Radiometric scenes get W/m² of
// 179 lm each.
void add_sky(Scene& scene, const SkyRequest& request, const Compass& compass);

// An image of the surroundings (lat-long: the middle column lies in the compass' east, and further
// right is further clockwise, seen from above, after a turn by `rotation_deg` clockwise;
// equal-area: z is up and x east). The light is called "environment".
void add_environment(Scene& scene, EnvironmentMap map, double scale, double rotation_deg,
                     const Compass& compass);

}  // namespace troffer
