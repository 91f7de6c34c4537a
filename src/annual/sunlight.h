// Exposure to sunlight: how long the sun reaches a place on one day under a cloudless sky.
//
// References: [1] EN 17037:2018+A1:2021, 5.3 and annex D: 1.5, 3 and 4 hours on a day between
//   1 February and 21 March, at a point in the opening.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "annual/light_paths.h"
#include "daylight/sky_lights.h"
#include "lighting/weather_year.h"
#include "render/measure.h"

namespace troffer {

struct SunlightLevel {
  double hours = 0;
  const char* name = "";
};
inline constexpr std::array sunlight_levels{SunlightLevel{1.5, "minimum"},
                                            SunlightLevel{3, "medium"}, SunlightLevel{4, "high"}};

struct SunlightDay {
  int month = 3, day = 21;
  double least_altitude_deg = 0;  // the sun counts from this altitude on [1]
};

// Parses "MM-DD" or "MM-DD,DEGREES". Throws UsageError for other texts.
SunlightDay parse_sunlight_day(const std::string& text);

// Returns the hours of sunlight at each point, minute by minute. The sun is a point, and light
// counts from any side of the normal. The groups of all paths are in state 0.
std::vector<double> sunlight_hours(const std::vector<LightPath>& paths,
                                   const std::vector<MeasuringPoint>& points,
                                   const WeatherYear& year, const Compass& compass,
                                   const SunlightDay& day, int threads);

// Name of the level that a duration reaches, or "none".
std::string sunlight_level(double hours);

}  // namespace troffer
