// Electric light beside daylight: groups of luminaires at full output, and how far each can be
// dimmed in every hour so that its sensors keep a target.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "annual/year_times.h"
#include "render/measure.h"
#include "transport/prepared_scene.h"

namespace troffer {

struct ElectricGroup {
  std::string name;                 // as typed
  std::vector<std::string> lights;  // names of lights
};

// Makes one group per text, "NAME[,NAME…]" with '*' for any letters. Throws UsageError for names
// that no light has, and for lights of several groups.
std::vector<ElectricGroup> electric_groups(const Scene& scene,
                                           const std::vector<std::string>& texts);

// Illuminance of sensors by a group at full output, lx.
struct ElectricLight {
  std::string name;
  std::vector<double> lx, error;  // per sensor, with its standard error
};

// Measures each group alone, with all reflected light. Returns fewer groups once `stop` is set.
std::vector<ElectricLight> measure_electric(const Scene& scene,
                                            const std::vector<ElectricGroup>& groups,
                                            const std::vector<MeasuringPoint>& points,
                                            uint64_t seed, int threads, const StopFlag& stop);

// Use of one group over a year.
struct DimmedUse {
  std::string name;
  size_t sensors = 0;          // at which it brings most electric light
  double mean_lx = 0;          // electric light of all groups there, at full output
  double occupied_hours = 0;   // full output during occupancy
  double full_load_hours = 0;  // equivalent hours of full output with dimming
};

// Collects daylight at the sensors of each group. A group serves the sensors at which it brings
// most electric light. In every occupied step, it is dimmed to the least output at which the mean
// illuminance of its sensors reaches the target. Other groups that light these sensors are assumed
// to have the same output.
class DimmingYear {
 public:
  DimmingYear(const std::vector<ElectricLight>& lights, double target_lx);

  // Adds daylight of a sensor in the hours of YearSkies, lx.
  void add(size_t sensor, std::span<const float> daylight);
  std::vector<DimmedUse> use(const YearTimes& times, int steps_per_hour) const;

 private:
  const std::vector<ElectricLight>& lights_;
  double target_lx_;
  std::vector<int> group_of_;                  // per sensor; -1: no electric light
  std::vector<size_t> sensors_;                // per group
  std::vector<double> electric_;               // per group: sum over its sensors, lx
  std::vector<std::vector<double>> daylight_;  // per group and hour: sum over its sensors, lx
};

}  // namespace troffer
