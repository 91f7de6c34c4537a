// --weather: sky and sun as a weather file measured them.
//
// References: [1] EnergyPlus, "Auxiliary Programs", chapter "EnergyPlus Weather File (EPW) Data
//   Dictionary".
#pragma once

#include <string>

namespace troffer {

// An hour of a weather file, and the time asked for in it.
struct Weather {
  double latitude_deg = 0, longitude_deg = 0;
  double julian_day_ut = 0;
  double direct_normal = 0, diffuse_horizontal = 0;  // W/m², means over the hour
  double global_horizontal = 0;                      // W/m², for a check of these two; 0: missing
};

// `date`: "MM-DDTHH:MM", in the file's standard time, of any year. The row of the hour that it lies
// in counts [1] (24:00 ends a day's last), and the year is that row's. UsageError for dates that
// are none, with the part that is wrong; InputError with the line for files that are no EPW or lack
// that hour or its irradiances.
Weather read_weather(const std::string& path, const std::string& date);
// The hour of a moment (universal time, as a Julian day), whatever its year; julian_day_ut is that
// moment.
Weather read_weather(const std::string& path, double julian_day_ut);

}  // namespace troffer
