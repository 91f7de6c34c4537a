// A year of weather: irradiances and sun positions of every time step of an EPW or Radiance .wea
// file. Used by `troffer annual`. Angles are in degrees, irradiances in W/m² of all wavelengths.
//
// References: [1] EnergyPlus, "Auxiliary Programs", chapter "EnergyPlus Weather File (EPW) Data
//   Dictionary".
//   [2] Radiance, manual page gendaymtx(1): the format of .wea files.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "base/sun_position.h"

namespace troffer {

// One time step. The sun stands where it does in the middle of the step.
struct WeatherStep {
  int month = 1, day = 1;
  double hour = 0;          // middle of the step, the file's standard time, [0, 24)
  double hour_of_year = 0;  // the same, from the first of January
  double direct_normal = 0, diffuse_horizontal = 0;
  SunPosition sun;
};

struct WeatherYear {
  std::string place;
  double latitude_deg = 0, longitude_deg = 0;  // north, east
  double zone_hours = 0;                       // standard time minus universal time
  int steps_per_hour = 1;
  bool has_leap_day = false;
  std::vector<WeatherStep> steps;
  size_t filled = 0;  // steps without irradiances, which got those of the nearest day
};

// Reads a file by its ending: ".wea", else EPW [1]. A step without irradiances gets those of the
// nearest day at the same time. Direct irradiance on a horizontal plane (units 2 of .wea [2]) is
// converted. Throws InputError with the line for files of other formats, for values outside their
// range, and for files without any irradiance.
WeatherYear read_weather_year(const std::string& path);

}  // namespace troffer
