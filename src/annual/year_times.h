// Times of a year that metrics count: occupied hours, daylight hours of EN 17037, and the hours of
// LEED's option 2.
//
// References: [1] EN 17037:2018+A1:2021, "Daylight in buildings", 5.1 and annex A.
//   [2] USGBC, "LEED v4.1 Building Design and Construction", EQ credit Daylight, option 2.
//   [3] IES LM-83-12, "Spatial daylight autonomy and annual sunlight exposure".
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "annual/year_skies.h"

namespace troffer {

// Flags are per hour of YearSkies. Counts are in time steps and include those without daylight.
struct YearTimes {
  std::vector<uint8_t> is_occupied;
  size_t occupied = 0;
  // The half of the year with the most diffuse horizontal light [1].
  std::vector<uint8_t> is_daylight;
  size_t daylight = 0;
  // The clearest 9 a.m. (0) and 3 p.m. (1) within 15 days of each equinox [2]; empty if the file
  // lacks those days.
  std::vector<uint32_t> mornings, afternoons;
};

// occupancy: "8-18" for a span of hours on every day [3], or the name of a file with one number per
// time step of the year, of which 0 means unoccupied. Throws UsageError for other texts and
// InputError for files of another length.
YearTimes make_year_times(const WeatherYear& year, const YearSkies& skies,
                          const std::string& occupancy);

}  // namespace troffer
