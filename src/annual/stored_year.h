// Reads the folder that `troffer annual` wrote, for `troffer view --annual`: sensors, hours, window
// groups with their states, and where the hourly arrays are. The files may come from anyone, so
// everything is checked.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "annual/npy_array.h"
#include "render/measure.h"

namespace troffer {

// A window group.
struct StoredGroup {
  std::string name;                 // as annual.json has it
  std::vector<std::string> states;  // their names
  std::vector<uint16_t> schedule;   // state in every hour
};

// Sensors first … first + count - 1.
struct StoredGrid {
  std::string name;
  size_t first = 0, count = 0;
};

// Illuminance that one window group in one state brings to one grid.
struct StoredState {
  static constexpr size_t no_group = size_t(-1);
  size_t grid = 0;
  size_t group = no_group;  // no_group: windows outside of all groups
  size_t state = 0;
  NpyArray total, direct;
};

struct StoredYear {
  std::string folder;
  std::string scene, place;   // file of the scene, place of the weather, as annual.json has them
  double zone_hours = 0;      // standard time minus universal time
  std::vector<double> hours;  // middles of the hours with the sun up, from the first of January
  int steps_per_hour = 1;
  bool has_leap_day = false;
  std::vector<StoredGroup> groups;
  std::vector<StoredGrid> grids;
  std::vector<MeasuringPoint> points;           // sensors, in the scene file's coordinates
  std::vector<StoredState> states;              // all that bring light
  std::vector<std::optional<NpyArray>> errors;  // standard errors of each grid, if there
};

// Throws InputError for a folder without the files of `troffer annual`, or whose files do not fit
// each other.
StoredYear read_stored_year(const std::string& folder);

}  // namespace troffer
