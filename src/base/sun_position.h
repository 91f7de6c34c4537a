// Position of the sun by place and time. Used for skies, daylight and Mitsuba's sun. Angles are in
// degrees, times are Julian days of universal time.
//
// References: [1] Meeus, "Astronomical Algorithms", 2nd ed., 1998: ch. 7 (Julian day), 12 (sidereal
//   time), 13 (coordinates), 16 (refraction, Eq. 16.4), 22 (nutation), 25 (the sun, low accuracy).
//   [2] Meeus, "Astronomical Formulae for Calculators", 4th ed., 1988, ch. 18 (perturbations).
#pragma once

#include <string>

namespace troffer {

struct SunPosition {
  double azimuth_deg = 0;   // clockwise from north as seen from above: [0, 360)
  double altitude_deg = 0;  // above the horizon, as seen through a standard atmosphere
  double distance_au = 1;
};

// Julian day of a universal time in the Gregorian calendar. `hour` may be any number.
double julian_day(int year, int month, int day, double hour);

// Position for a latitude north and a longitude east of Greenwich, in degrees. It is within 0.01
// degrees of the published examples in tests/base/test_sun_position.cpp.
SunPosition sun_position(double latitude_deg, double longitude_deg, double julian_day_ut);

// Parses "2026-06-21T12:00+02:00", also with seconds, "Z", a blank for "T" or "+0200", to a Julian
// day. Throws UsageError, which begins with `option` and names the wrong part, for other texts and
// for years outside 1900 to 2200.
double parse_time(const std::string& text, const std::string& option);

}  // namespace troffer
