#include "base/sun_position.h"

#include <cmath>
#include <cstdio>

#include "base/error.h"
#include "base/units.h"

namespace troffer {

namespace {

constexpr double j2000 = 2451545.0;
constexpr double days_per_century = 36525;
// Terrestrial minus universal time since about 2015; a minute more moves the sun by 1e-3 degrees
// among the stars.
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

// Apparent place of the sun [1, ch. 25], with what Venus, Jupiter and the moon add [2]; t in
// centuries of terrestrial time from J2000.
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

// Greenwich, apparent [1, Eq. 12.4 and p. 88].
double sidereal_time_deg(double julian_day_ut) {
  const double days = julian_day_ut - j2000, t = days / days_per_century;
  const double node = 125.04 - 1934.136 * t;
  return 280.46061837 + 360.98564736629 * days + 0.000387933 * t * t -
         0.00478 * sine(node) * cosine(23.4393);
}

// What air at 1010 hPa and 10 °C adds to an altitude [1, Eq. 16.4]; nothing well below the horizon.
double refraction_deg(double altitude_deg) {
  if (altitude_deg < -0.575) return 0;
  const double angle = altitude_deg + 10.3 / (altitude_deg + 5.11);
  return 1.02 / 60 / std::tan(rad_from_deg(angle));
}

int days_of(int year, int month) {
  static constexpr int days[] = {31, 28, 31, 30, 31, 30, 31, 31, 30, 31, 30, 31};
  const bool is_leap = year % 4 == 0 && (year % 100 != 0 || year % 400 == 0);
  return days[month - 1] + (month == 2 && is_leap ? 1 : 0);
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
  int year = 0, month = 0, day = 0, hour = 0, minute = 0, used = 0, more = 0;
  double second = 0;
  bool is_fine = std::sscanf(text.c_str(), "%4d-%2d-%2dT%2d:%2d%n", &year, &month, &day, &hour,
                             &minute, &used) == 5;
  std::string zone = is_fine ? text.substr(size_t(used)) : "";
  if (is_fine && std::sscanf(zone.c_str(), ":%2lf%n", &second, &more) == 1)
    zone = zone.substr(size_t(more));
  double offset_hours = 0;
  if (is_fine && zone != "Z" && zone != "z") {
    char sign = 0;
    int h = 0, m = 0, end = 0;
    is_fine = std::sscanf(zone.c_str(), "%c%2d:%2d%n", &sign, &h, &m, &end) == 3 &&
              size_t(end) == zone.size() && (sign == '+' || sign == '-') && h >= 0 && h <= 14 &&
              m >= 0 && m < 60;
    offset_hours = (sign == '-' ? -1 : 1) * (h + m / 60.0);
  }
  // 24:00 is the end of a day, and 60 a leap second.
  is_fine = is_fine && year >= 1900 && year <= 2200 && month >= 1 && month <= 12 && day >= 1 &&
            day <= days_of(year, month) && hour >= 0 && minute >= 0 && minute <= 59 &&
            (hour < 24 || (hour == 24 && minute == 0 && second == 0)) && second >= 0 && second < 61;
  if (!is_fine)
    throw UsageError(option + ": cannot read '" + text +
                     "' as a time such as 2026-06-21T12:00+02:00 or 2026-06-21T10:00Z");
  return julian_day(year, month, day, hour + minute / 60.0 + second / 3600 - offset_hours);
}

}  // namespace troffer
