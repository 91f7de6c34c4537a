/// @file
/// Computes a year of daylight: illuminance in every hour of a weather file, and annual metrics.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "troffer/measure.h"
#include "troffer/scene.h"

namespace troffer::api {

/// Sensors that are assessed together, such as those of a room.
struct SensorGrid {
  std::string name{};                  ///< for the results
  std::vector<MeasurePoint> points{};  ///< each stands for the same area
};

/// Options of a year of daylight. Files are as for the program's options of these names.
struct AnnualOptions {
  double north = 0;               ///< degrees clockwise from above, from -z (from +y if z is up)
  double ground = 0.2;            ///< reflectance of the ground below the sky, 0 to 1
  std::string occupancy{"8-18"};  ///< hours of every day, or a file with one number per step
  std::string groups{};           ///< file of window groups; empty: those of a Honeybee model
  std::string blinds{"lm-83"};    ///< "lm-83", "open", or a file with a column of states per group
  double threshold = 300;         ///< of daylight autonomy and sDA, lx
  int subdivision = 4;            ///< fineness of the sky: 144 N² + 1 patches, 1 to 8
  int gather_rays = 0;            ///< per sensor, for reflected light; 0: by the number of sensors
  /// Eyes that are rated for glare; the normal is the line of sight.
  std::vector<MeasurePoint> eyes{};
  /// Points whose exposure to sunlight is found; the sun counts from both sides.
  std::vector<MeasurePoint> sunlight{};
  std::string sunlight_day{"03-21"};    ///< "MM-DD", or "MM-DD,DEGREES": least altitude of the sun
  std::vector<std::string> electric{};  ///< groups of lights that daylight dims: "NAME[,NAME…]"
  double electric_target = 500;         ///< that daylight and electric light reach together, lx
  int threads = 0;                      ///< 0: all cores; any number gives the same result
  std::uint64_t seed = 0;               ///< of the random numbers
};

/// A metric with its standard error. ± 1.96 standard errors is a 95 % confidence interval.
struct AnnualMetric {
  std::string key{};          ///< as in annual.json, such as "sda"
  std::string title{};        ///< in words
  std::string unit{};         ///< "%", "lx", "h" or "klx h"
  double value = 0;           ///< in this unit
  double standard_error = 0;  ///< in this unit
};

/// A requirement of a standard.
struct AnnualRequirement {
  std::string title{};        ///< which standard and level
  std::string need{};         ///< what it asks
  double value = 0;           ///< what was found, %
  double standard_error = 0;  ///< standard error, %
  std::string verdict{};      ///< "met", "not met", or "undecided" within two standard errors
};

/// Metrics of one grid. Its sensors are first to first + count - 1 of AnnualDaylight.
struct AnnualGrid {
  std::string name{};                             ///< as given
  std::size_t first = 0;                          ///< its first sensor
  std::size_t count = 0;                          ///< number of its sensors
  std::vector<AnnualMetric> metrics{};            ///< sDA, ASE, means of sensors' metrics
  std::vector<AnnualRequirement> requirements{};  ///< of EN 17037 and LEED v4.1
};

/// One metric of all sensors.
struct SensorMetric {
  std::string key{};                      ///< as in metrics.csv, such as "da"
  std::string title{};                    ///< in words
  std::string unit{};                     ///< "%", "lx", "h" or "klx h"
  std::vector<double> values{};           ///< per sensor
  std::vector<double> standard_errors{};  ///< per sensor
};

/// A window group and its state in every hour.
struct WindowGroupYear {
  std::string name{};                  ///< of the group
  std::vector<std::string> states{};   ///< names of its states
  std::vector<std::uint16_t> shown{};  ///< number of the state that it shows, per hour
};

/// Daylight glare at an eye.
struct EyeGlare {
  std::vector<float> vertical_lx{};  ///< illuminance of the eye per hour, lx, blinds as operated
  std::vector<float> dgp{};          ///< Daylight Glare Probability per hour, 0 to 1
  /// Shares of the occupied hours with a DGP above .35, .40 and .45, 0 to 1.
  std::array<double, 3> shares{};
  std::string level{};  ///< protection from glare by EN 17037: "high", "medium", "minimum", "none"
};

/// Exposure of a point to sunlight on AnnualOptions::sunlight_day.
struct SunlightExposure {
  double hours = 0;     ///< under a cloudless sky
  std::string level{};  ///< by EN 17037: "high", "medium", "minimum", "none"
};

/// Electric light of one group of lights, dimmed by daylight.
struct ElectricYear {
  std::string name{};                     ///< as given
  std::vector<double> lx{};               ///< per sensor at full output
  std::vector<double> standard_errors{};  ///< per sensor, lx
  std::size_t sensors = 0;                ///< number of sensors that the group serves
  double mean_lx = 0;          ///< electric light of all groups at these sensors, at full output
  double occupied_hours = 0;   ///< per year
  double full_load_hours = 0;  ///< equivalent hours of full output with dimming, per year
};

/// Result of annual(). An hour is a time step of the weather file in whose middle the sun is up.
struct AnnualDaylight {
  std::size_t sensors = 0;                   ///< of all grids together
  std::vector<double> hours{};               ///< middle of each hour, from the first of January
  std::vector<std::uint8_t> occupied{};      ///< per hour: 1 if it counts for metrics
  std::vector<float> total{};                ///< lx, blinds as operated: sensor by sensor
  std::vector<float> standard_error{};       ///< standard error of `total`, lx
  std::vector<float> direct{};               ///< lx straight from the sun, blinds open
  std::vector<SensorMetric> metrics{};       ///< of sensors
  std::vector<AnnualGrid> grids{};           ///< in the order given
  std::vector<WindowGroupYear> groups{};     ///< window groups
  std::vector<EyeGlare> eyes{};              ///< one per item of AnnualOptions::eyes
  std::vector<SunlightExposure> sunlight{};  ///< one per item of AnnualOptions::sunlight
  std::vector<ElectricYear> electric{};      ///< one per item of AnnualOptions::electric
  std::string place{};                       ///< of the weather file
  double relative_error = 0;                 ///< of hours, root mean square
  bool is_complete = true;  ///< false after a stop; hours and metrics are then empty

  /// Returns the hours of one sensor in `total`, `standard_error` or `direct`.
  std::span<const float> of(const std::vector<float>& which, std::size_t sensor) const {
    return std::span(which).subspan(sensor * hours.size(), hours.size());
  }
};

/// Computes a year of daylight as `troffer annual` does. `weather` is an .epw file, or Radiance's
/// .wea. Without grids, the sensors are those of a Honeybee model. All light sources of the scene
/// are off, except for AnnualOptions::electric. Memory: 12 bytes per sensor and hour.
/// @throws InputError for files that cannot be used
/// @throws UsageError for invalid points and options, for names that no light has, and for window
/// groups of a Honeybee model
///   whose surfaces or materials were changed after loading
AnnualDaylight annual(Scene& scene, const std::string& weather,
                      const std::vector<SensorGrid>& grids = {}, const AnnualOptions& options = {},
                      const Progress& progress = {});

}  // namespace troffer::api
