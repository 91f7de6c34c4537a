// Operation of blinds: which state each window group shows in each hour of a year, by IES LM-83 or
// by a table.
//
// References: [1] IES LM-83-12, "Spatial daylight autonomy and annual sunlight exposure".
//   [2] Ladybug Tools, honeybee-radiance-postprocess, leed_schedule.py: the order of closing.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "annual/light_paths.h"
#include "annual/year_skies.h"

namespace troffer {

// Illuminance straight from the sun in one hour of YearSkies.
struct SunHour {
  uint32_t hour = 0;
  float lx = 0;
};
// Hours with sun at each sensor; hours increase.
using SunOfSensors = std::vector<std::vector<SunHour>>;

// Direct sun by way of one path at all sensors: with the group open (state 0), and with its last
// state, which counts as closed.
struct SunOfPath {
  SunOfSensors open, closed;
};

// Operates blinds so that at most 2 % of the sensors of each grid get 1000 lx or more straight from
// the sun [1]. In each hour, groups close one after the other until the grid complies; the
// group that brings that much sun to the most sensors closes first [2]. A group without sun stays
// open. Groups show state 0
// or their last state. A group closes if any grid asks for it. Paths with one state stay as they
// are.
StateSchedule lm83_schedule(const std::vector<LightPath>& paths, std::span<const SunOfPath> sun,
                            std::span<const SensorSpan> grids, size_t hours);

// Reads a table with one column of state numbers per group, named in the header, and one row per
// time step of the weather file. Groups without a column show state 0. Throws InputError for other
// tables.
StateSchedule read_state_schedule(const std::string& file, const std::vector<LightPath>& paths,
                                  const WeatherYear& year, const YearSkies& skies);

}  // namespace troffer
