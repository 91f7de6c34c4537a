// Contents of the outputs of `troffer annual`: grids with their points and results. The command
// fills it in; annual_text.h, annual_page.h and honeybee_folder.h write it.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "annual/annual.h"
#include "annual/annual_extras.h"
#include "render/measure.h"

namespace troffer {

// Sensors first … first + count - 1.
struct AnnualGrid {
  std::string name;  // may hold any bytes
  size_t first = 0, count = 0;
  GridResult result;
  // Mean over the grid per hour of YearSkies: illuminance in lx, and % of sensors from 300 lx on.
  std::vector<float> mean_lx, share_300;
};

struct AnnualReport {
  std::string title, scene, weather_file, version, command;
  std::vector<std::string> warnings;
  std::string occupancy, blinds;  // as typed
  double da_lx = 300, north_deg = 0;
  int subdivision = 4;
  const WeatherYear& year;
  const Compass& compass;
  const std::vector<MeasuringPoint>& points;
  const AnnualResult& result;
  std::vector<AnnualGrid> grids;
  const std::vector<LightPath>& paths;
  AnnualExtras extras;
};

// Occupied hours that a path spends in each of its states.
std::vector<double> hours_in_states(const AnnualReport& report, size_t path);

// "met", "not met" or "undecided".
const char* verdict_name(YearVerdict verdict);

// Name and unit of a sensor's figure, as columns of tables have them: "da", "%".
struct FigureColumn {
  SensorFigure figure;
  const char* name;
  const char* unit;
  const char* title;
};
// All figures of sensors, in their order.
std::span<const FigureColumn> figure_columns();

}  // namespace troffer
