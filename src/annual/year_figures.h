// Annual figures of a sensor and of a grid. Illuminance is in lx, shares are in per cent.
//
// References: [1] IES LM-83-12 (sDA, ASE).
//   [2] Reinhart & Walkenhorst, Energy and Buildings 33(7), 2001 (DA); Rogers, "Daylighting metric
//   development using daylight autonomy calculations in the sensor placement optimization tool",
//   2006 (continuous DA); Mardaljevic et al., "Daylighting metrics: is there a relation between
//   useful daylight illuminance and daylight glare probability?", 2012 (UDI).
//   [3] EN 17037:2018+A1:2021, annex A.
//   [4] USGBC, "LEED v4.1 Building Design and Construction", EQ credit Daylight.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "annual/year_times.h"

namespace troffer {

// Figures of one sensor.
enum class SensorFigure : size_t {
  da,                 // % of occupied hours from `da_lx` on
  da_open,            // the same with all blinds open
  cda,                // the same, hours below in proportion
  udi_fell_short,     // % of occupied hours below 100 lx
  udi_supplementary,  // from 100 to below 300 lx
  udi_autonomous,     // from 300 to 3000 lx
  udi_exceeded,       // above 3000 lx
  mean_lx,            // over occupied hours
  exposure_klxh,      // sum over all hours of the year, klx h
  sun_hours,          // occupied hours with more than 1000 lx straight from the sun, blinds open
  daylight_100,       // % of daylight hours from 100 lx on, blinds open
  daylight_300,
  daylight_500,
  daylight_750,
  morning_lx,    // LEED option 2: clear equinox, blinds open, 9 a.m. …
  afternoon_lx,  // … and 3 p.m.
  count,
};
constexpr size_t sensor_figures = size_t(SensorFigure::count);
using SensorFigures = std::array<double, sensor_figures>;

struct FigureSettings {
  double da_lx = 300;
};

// Illuminance of a sensor in the hours of a year (YearSkies).
struct HoursOfFigures {
  std::span<const float> total;  // with blinds as they are operated
  std::span<const float> open;   // with blinds open; the same as `total` without blinds
  std::span<const float> sun;    // part of `open` that comes straight from the sun
};

// Returns the figures of one sensor. Standards that assess a building without movable shading (ASE,
// EN 17037, LEED option 2) get the hours with blinds open. steps_per_hour: of the weather file.
SensorFigures figures_of(const HoursOfFigures& hours, const YearTimes& times, int steps_per_hour,
                         const FigureSettings& settings);

// Returns the standard error of the mean of n values, which may be few: 95 % of the intervals
// mean ± 1.96 errors hold the true value, as for Measurement. squares: sum of squared deviations
// from the mean. 0 with fewer than two values.
double error_of_mean(double squares, size_t n);

// A value with its standard error.
struct YearFigure {
  double value = 0, error = 0;
};
// Returns the value of all replicates together, with the error by their spread (error_of_mean()).
YearFigure with_spread(double of_all, std::span<const double> of_replicates);

// Figures of all sensors, from all replicates together (set 0) and from each alone.
class FigureTable {
 public:
  FigureTable(size_t sensors, size_t replicates)
      : sensors_(sensors), sets_(replicates + 1), values_(sensors * sets_) {}
  SensorFigures& at(size_t sensor, size_t set) { return values_[sensor * sets_ + set]; }
  const SensorFigures& at(size_t sensor, size_t set) const { return values_[sensor * sets_ + set]; }
  size_t sensors() const { return sensors_; }
  size_t sets() const { return sets_; }
  YearFigure of(size_t sensor, SensorFigure figure) const;

 private:
  size_t sensors_, sets_;
  std::vector<SensorFigures> values_;
};

// A figure of a grid, as tables show it.
struct GridFigure {
  std::string key;    // "sda"
  std::string title;  // "Spatial daylight autonomy 300/50 %"
  std::string unit;   // "%"
  YearFigure figure;
};

// A requirement of a standard, and whether a grid meets it.
enum class YearVerdict { met, not_met, undecided };
enum class YearScheme { leed_option_1, leed_ase, leed_option_2, en_17037 };
struct GridRequirement {
  YearScheme scheme = YearScheme::en_17037;
  int level = 1;      // points of LEED; 1 minimum, 2 medium, 3 high in EN 17037
  std::string title;  // "EN 17037, target illuminance 300 lx (minimum)"
  std::string need;   // "at least 50 % of the plane"
  YearFigure figure;
  YearVerdict verdict = YearVerdict::undecided;
};

struct GridResult {
  std::vector<GridFigure> figures;
  std::vector<GridRequirement> requirements;
};

// Levels of a scheme: the best one whose requirements are all met, and the best one that may be met
// once undecided requirements are decided. 0: none.
struct ReachedLevel {
  int sure = 0, possible = 0;
};
ReachedLevel level_reached(const GridResult& result, YearScheme scheme);

// Figure of several grids together, weighted by their numbers of sensors. The grids' errors may
// depend on each other, so they add up.
YearFigure joint_figure(std::span<const YearFigure> figures, std::span<const size_t> sensors);
// Verdict on "at least" or "at most" a limit. Undecided within two standard errors.
YearVerdict year_verdict(const YearFigure& figure, double limit, bool is_least);

// Returns the figures of the sensors first … first + count - 1, each of which stands for the same
// area. A requirement is undecided if the limit lies within two standard errors. has_blinds: there
// are window groups with several states.
GridResult grid_result(const FigureTable& table, size_t first, size_t count, bool has_equinoxes,
                       bool has_blinds = false);

}  // namespace troffer
