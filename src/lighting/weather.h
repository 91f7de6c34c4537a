// --weather: sky and sun as measured in a weather file (EPW).
//
// References: [1] EnergyPlus, "Auxiliary Programs", chapter "EnergyPlus Weather File (EPW) Data
//   Dictionary".
#pragma once

#include <string>

namespace troffer {

// One hour of a weather file, and the requested time in it.
struct Weather {
  double latitude_deg = 0, longitude_deg = 0;
  double julian_day_ut = 0;
  double direct_normal = 0, diffuse_horizontal = 0;  // W/m², means over the hour
  double global_horizontal = 0;                      // W/m², to check the two above; 0: missing
};

// Reads the hour of `date`, "MM-DDTHH:MM" in the file's standard time. It uses the row whose hour
// contains the time [1] (24:00 is in the last hour of the day), and the year of that row. Throws
// UsageError for invalid dates, naming the wrong part. Throws InputError with the line for files
// that are no EPW or lack that hour or its irradiances.
Weather read_weather(const std::string& path, const std::string& date);
// Reads the hour that contains a moment (Julian day, universal time), in the row's year.
// julian_day_ut is that moment.
Weather read_weather(const std::string& path, double julian_day_ut);

}  // namespace troffer
