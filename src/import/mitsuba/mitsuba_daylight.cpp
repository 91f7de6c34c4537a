#include "import/mitsuba/mitsuba_daylight.h"

#include <algorithm>
#include <cmath>

#include "base/sun_position.h"
#include "base/units.h"
#include "import/mitsuba/mitsuba_values.h"

namespace troffer {

namespace {

// Luminance (cd/m²) per unit of Mitsuba's spectral radiance, W/(m² sr nm): 683 lm/W times the
// integral of the observer's luminance curve (nm).
constexpr double luminance_per_radiance = 683 * 106.857;

class DaylightReader {
 public:
  DaylightReader(const MitsubaNode& node, const MitsubaTree& tree, WarningLog& warnings)
      : node_(node),
        is_legacy_(tree.is_legacy()),
        warnings_(warnings),
        world_(get_transform(node, "to_world")) {}
  void read(const std::function<void(Light)>& add);

 private:
  const MitsubaNode& node_;
  bool is_legacy_;
  WarningLog& warnings_;
  Affine world_;

  // Up to version 0.6, y is up and -z north; later z is up and x north [1, 2].
  Vec3d up() const { return normalize(world_.columns[is_legacy_ ? 1 : 2]); }
  Vec3d in_world(double azimuth_rad, double altitude_rad) const;
  Vec3d to_sun() const;
  Light sky(double turbidity, double height, double scale, const Vec3d& to_sun) const;
  Light sun(double turbidity, double height, double scale) const;
  double sun_radius_rad() const;
};

Vec3d DaylightReader::in_world(double azimuth_rad, double altitude_rad) const {
  const double level = std::cos(altitude_rad), high = std::sin(altitude_rad);
  const double north = level * std::cos(azimuth_rad), east = level * std::sin(azimuth_rad);
  return normalize(
      world_.vector(is_legacy_ ? Vec3d{east, high, -north} : Vec3d{north, east, high}));
}

// Direction to the sun: given in the world, or computed from place and time. Mitsuba's default is
// Tokyo on 10 July 2010 at 15:00.
Vec3d DaylightReader::to_sun() const {
  const auto given = get_vector(node_, "sun_direction");
  const double latitude = get_number(node_, "latitude", 35.6894);
  const double longitude = get_number(node_, "longitude", 139.6917);
  const double zone = get_number(node_, "timezone", 9);
  const double hour = get_number(node_, "hour", 15) - zone + get_number(node_, "minute", 0) / 60 +
                      get_number(node_, "second", 0) / 3600;
  const int year = get_integer(node_, "year", 2010);
  const int month = get_integer(node_, "month", 7), day = get_integer(node_, "day", 10);
  if (given && length(*given) > 0) return normalize(*given);
  const bool is_date = year >= 1900 && year <= 2200 && month >= 1 && month <= 12 && day >= 1 &&
                       day <= 31 && std::abs(hour) <= 100;
  if (!is_date || std::abs(latitude) > 90 || std::abs(longitude) > 360)
    node_.place.fail("no such place or time");
  const SunPosition at = sun_position(latitude, longitude, julian_day(year, month, day, hour));
  return in_world(rad_from_deg(at.azimuth_deg), rad_from_deg(at.altitude_deg));
}

// Luminance distribution of a clear sky of that turbidity [3].
Light DaylightReader::sky(double turbidity, double height, double scale,
                          const Vec3d& to_sun) const {
  const double t = turbidity, theta = pi / 2 - height;
  Light e;
  e.kind = LightKind::sky;
  e.sky.a = float(0.1787 * t - 1.4630);
  e.sky.b = float(-0.3554 * t + 0.4275);
  e.sky.c = float(-0.0227 * t + 5.3251);
  e.sky.d = float(0.1206 * t - 2.5771);
  e.sky.e = float(-0.0670 * t + 0.3703);
  const double chi = (4.0 / 9 - t / 120) * (pi - 2 * theta);
  const double zenith = 1000 * ((4.0453 * t - 4.9710) * std::tan(chi) - 0.2155 * t + 2.4192);
  const double of_shape = (1 + double(e.sky.a) * std::exp(double(e.sky.b))) *
                          (1 + double(e.sky.c) * std::exp(double(e.sky.d) * theta) +
                           double(e.sky.e) * sqr(std::cos(theta)));
  e.radiance = Rgb{float(scale * std::max(zenith, 0.0) / of_shape / luminance_per_radiance)};
  const Vec3d z = up();
  const Vec3d x = normalize(cross(std::abs(z.x) < 0.9 ? Vec3d{1, 0, 0} : Vec3d{0, 0, 1}, z));
  e.axes = {Vec3(x), Vec3(cross(z, x)), Vec3(z)};
  e.direction = Vec3(-to_sun);
  return e;
}

double DaylightReader::sun_radius_rad() const {
  const double whole = get_number(node_, "sun_aperture", 0.5332);
  return rad_from_deg(whole / 2 * get_number(node_, "sun_radius_scale", 1));
}

// Converts the illuminance that a plane facing the sun receives through air of that turbidity.
Light DaylightReader::sun(double turbidity, double height, double scale) const {
  Light e;
  e.kind = LightKind::sun;
  e.angular_radius = float(sun_radius_rad());
  const double lux = 133'800 * std::exp(-0.07 * turbidity / std::sin(height));
  e.radiance = Rgb{
      float(scale * lux / luminance_per_radiance / (pi * sqr(std::sin(double(e.angular_radius)))))};
  return e;
}

void DaylightReader::read(const std::function<void(Light)>& add) {
  const double turbidity = std::clamp(get_number(node_, "turbidity", 3), 1.7, 10.0);
  const double both = get_number(node_, "scale", 1);
  const double sky_scale = get_number(node_, "sky_scale", both);
  const double sun_scale = get_number(node_, "sun_scale", both);
  for (const char* name : {"albedo", "resolution", "stretch", "extend", "complex_sun"})
    find_parameter(node_, name);
  const double radius = sun_radius_rad();
  const Vec3d direction = to_sun();
  const double height = std::asin(std::clamp(dot(direction, up()), -1.0, 1.0));
  const std::string label = "emitter \"" + shortened(node_.type) + "\": ";
  warnings_.add(label +
                "is approximated: white, with the luminance of a clear sky of its turbidity");
  if (!is_finite(Vec3(up())) || !(height > 0)) {
    warnings_.add(label + "the sun is below the horizon: left out");
    return;
  }
  const bool has_sun = node_.type != "sky" && sun_scale > 0 && radius > 1e-6 && radius < 1;
  if (node_.type != "sun" && sky_scale > 0) add(sky(turbidity, height, sky_scale, direction));
  if (!has_sun) return;
  Light e = sun(turbidity, height, sun_scale);
  e.direction = Vec3(-direction);
  add(std::move(e));
}

}  // namespace

void add_mitsuba_daylight(const MitsubaNode& node, const MitsubaTree& tree, WarningLog& warnings,
                          const std::function<void(Light)>& add) {
  DaylightReader(node, tree, warnings).read(add);
}

}  // namespace troffer
