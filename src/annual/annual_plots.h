// Drawings of the annual page: plans of grids in false colours, maps of day by hour, and the sun's
// paths. All are HTML elements that need no scripts.
#pragma once

#include <string>

#include "annual/annual_report.h"

namespace troffer {

// A linear scale of colours.
struct ColourRange {
  double least = 0, largest = 100;
};

// Plan of a grid with one coloured square and value per sensor, `width` CSS px at most. North is
// marked. values: one per sensor of the grid.
std::string grid_plan(const AnnualReport& report, const AnnualGrid& grid,
                      std::span<const double> values, const std::string& unit,
                      const ColourRange& range, double width);

// Plan of all grids with the eyes: numbered discs in the colour of their level of protection from
// glare, and a line towards where each looks.
std::string eyes_plan(const AnnualReport& report, double width);

// Map with days to the right and hours upward. values: one per hour of YearSkies.
std::string day_hour_map(const AnnualReport& report, std::span<const float> values,
                         const std::string& unit, const ColourRange& range,
                         const std::string& title);

// Paths of the sun on the 21st of six months, over horizon and compass, with the hours of standard
// time.
std::string sun_paths(const WeatherYear& year, double side);

}  // namespace troffer
