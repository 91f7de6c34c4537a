// Adds a sky, the ground below it, the sun, or an environment image to a scene as lights. The
// command line (lighting/daylight_options.h) and Python use it. Angles are in degrees, illuminances
// in lx; sky_model.h provides luminance and illuminance.
#pragma once

#include <optional>

#include "base/vec.h"
#include "scene/scene.h"

namespace troffer {

// Unit, orthogonal world directions. East is mirrored in mirrored worlds (as in pbrt).
struct Compass {
  Vec3d east{1, 0, 0}, north{0, 0, -1}, up{0, 1, 0};

  // Returns the direction of an azimuth, clockwise from north seen from above, and an altitude
  // above the horizon.
  Vec3d direction(double azimuth_deg, double altitude_deg) const;
};

// Makes a compass. North lies `north_deg` clockwise, seen from above, from -z, or from +y if z or
// -z is up.
Compass make_compass(const Vec3& up, double north_deg, bool is_mirrored);

struct SunRequest {
  double azimuth_deg = 0, altitude_deg = 45;
  double distance_au = 1;
  std::optional<double> direct_lx;  // on a plane facing the sun; default: typical value
};

enum class SkyKind { even, cie, perez };

struct SkyRequest {
  SkyKind kind = SkyKind::even;
  int cie_type = 1;                                  // cie
  double direct_normal = 0, diffuse_horizontal = 0;  // perez: W/m², all wavelengths
  std::optional<double> diffuse_lx;  // on a horizontal plane; default: typical value
  std::optional<SunRequest> sun;     // must be above the horizon
  std::optional<double> turbidity;   // Linke turbidity, for clear types with a sun
  double ground_reflectance = 0.2;
};

// True if the sky depends on the sun's position.
bool needs_sun(const SkyRequest& request);

// Appends the light "sky", and "sun" if it emits. Both are white. The ground has the given
// reflectance and emits diffusely the light that falls on it. Radiometric scenes get W/m² at 179
// lm/W.
void add_sky(Scene& scene, const SkyRequest& request, const Compass& compass);

// Appends an image of the surroundings as the light "environment". A lat-long image has its middle
// column in the compass' east, and columns to the right lie clockwise seen from above.
// `rotation_deg` turns it clockwise. An equal-area image has z up and x east.
void add_environment(Scene& scene, EnvironmentMap map, double scale, double rotation_deg,
                     const Compass& compass);

}  // namespace troffer
