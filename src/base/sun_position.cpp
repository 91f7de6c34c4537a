#include "base/sun_position.h"

#include <cmath>

#include "base/time_text.h"
#include "base/units.h"

namespace troffer {

namespace {

constexpr double j2000 = 2451545.0;
constexpr double days_per_century = 36525;
// Terrestrial minus universal time, about its value since 2015. A minute more moves the sun by 1e-3
// degrees among the stars.
constexpr double delta_t_days = 69.0 / 86400;
constexpr double parallax_deg = 8.794 / 3600;

double sine(double deg) {
  return std::sin(rad_from_deg(deg));
}
double cosine(double deg) {
  return std::cos(rad_from_deg(deg));
}

struct Equatorial {
  double right_ascension_deg, declination_deg, distance_au;
};

// Apparent position of the sun [1, ch. 25], with perturbations by Venus, Jupiter and the moon [2].
// t is in centuries of terrestrial time from J2000.
Equatorial apparent_sun(double t) {
  const double mean_longitude = 280.46646 + t * (36000.76983 + t * 0.0003032);
  const double anomaly = 357.52911 + t * (35999.05029 - t * 0.0001537);
  const double eccentricity = 0.016708634 - t * (0.000042037 + t * 0.0000001267);
  const double centre = (1.914602 - t * (0.004817 + t * 0.000014)) * sine(anomaly) +
                        (0.019993 - t * 0.000101) * sine(2 * anomaly) +
                        0.000289 * sine(3 * anomaly);
  const double since_1900 = t + 1;
  const double perturbations = 0.00134 * cosine(153.23 + 22518.7541 * since_1900) +
                               0.00154 * cosine(216.57 + 45037.5082 * since_1900) +
                               0.00200 * cosine(312.69 + 32964.3577 * since_1900) +
                               0.00179 * sine(350.74 + 445267.1142 * since_1900);
  const double node = 125.04 - 1934.136 * t;
  const double longitude = mean_longitude + centre + perturbations - 0.00569 - 0.00478 * sine(node);
  const double obliquity = 23.4392911 - 0.0130042 * t + 0.00256 * cosine(node);
  return {deg_from_rad(std::atan2(cosine(obliquity) * sine(longitude), cosine(longitude))),
          deg_from_rad(std::asin(sine(obliquity) * sine(longitude))),
          1.000001018 * (1 - eccentricity * eccentricity) /
              (1 + eccentricity * cosine(anomaly + centre))};
}

// Apparent sidereal time at Greenwich [1, Eq. 12.4 and p. 88].
double sidereal_time_deg(double julian_day_ut) {
  const double days = julian_day_ut - j2000, t = days / days_per_century;
  const double node = 125.04 - 1934.136 * t;
  return 280.46061837 + 360.98564736629 * days + 0.000387933 * t * t -
         0.00478 * sine(node) * cosine(23.4393);
}

// Refraction of air at 1010 hPa and 10 °C [1, Eq. 16.4]; 0 well below the horizon.
double refraction_deg(double altitude_deg) {
  if (altitude_deg < -0.575) return 0;
  const double angle = altitude_deg + 10.3 / (altitude_deg + 5.11);
  return 1.02 / 60 / std::tan(rad_from_deg(angle));
}

}  // namespace

double julian_day(int year, int month, int day, double hour) {
  if (month <= 2) {
    --year;
    month += 12;
  }
  const int century = year / 100;
  return std::floor(365.25 * (year + 4716)) + std::floor(30.6001 * (month + 1)) + day + 2 -
         century + century / 4 - 1524.5 + hour / 24;
}

SunPosition sun_position(double latitude_deg, double longitude_deg, double julian_day_ut) {
  const Equatorial sun = apparent_sun((julian_day_ut + delta_t_days - j2000) / days_per_century);
  const double hour_angle =
      sidereal_time_deg(julian_day_ut) + longitude_deg - sun.right_ascension_deg;
  const double north = sine(sun.declination_deg) * cosine(latitude_deg) -
                       cosine(sun.declination_deg) * sine(latitude_deg) * cosine(hour_angle);
  const double east = -cosine(sun.declination_deg) * sine(hour_angle);
  const double up = sine(sun.declination_deg) * sine(latitude_deg) +
                    cosine(sun.declination_deg) * cosine(latitude_deg) * cosine(hour_angle);
  SunPosition p;
  p.azimuth_deg = deg_from_rad(std::atan2(east, north));
  if (p.azimuth_deg < 0) p.azimuth_deg += 360;
  const double altitude = deg_from_rad(std::atan2(up, std::sqrt(north * north + east * east)));
  const double seen = altitude - parallax_deg / sun.distance_au * cosine(altitude);
  p.altitude_deg = seen + refraction_deg(seen);
  p.distance_au = sun.distance_au;
  return p;
}

double parse_time(const std::string& text, const std::string& option) {
  TimeText t(text, option, "2026-06-21T12:00+02:00, or 2026-06-21T10:00Z");
  const int year = t.number("the year", 4, 1900, 2200);
  t.expect('-', "the month");
  const int month = t.number("the month", 2, 1, 12);
  t.expect('-', "the day");
  const int day = t.number("the day", 2, 1, days_of_month(year, month));
  t.expect_time();
  const TimeOfDay time = t.time_of_day(true);
  const double zone = t.zone_hours();
  if (!t.is_at_end()) t.fail("'" + std::string(t.rest()) + "' must not follow the time zone");
  return julian_day(year, month, day, time.hour + time.minute / 60.0 + time.second / 3600 - zone);
}

}  // namespace troffer
