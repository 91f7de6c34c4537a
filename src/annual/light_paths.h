// Ways by which daylight enters a scene: windows outside of all groups, and window groups such as
// the windows of one façade. Each group has states, such as blinds up and down. The light of a path
// is computed in a scene in which the windows of all other groups are black.
//
// The illuminance of a combination of states is the sum over paths. This leaves out light that
// passes windows of two groups, for example in through one and out through the other.
//
// References: [1] Ladybug Tools, honeybee-radiance: light paths and states of aperture groups.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "transport/prepared_scene.h"

namespace troffer {

// Name of the windows outside of all groups [1].
constexpr const char* static_path = "__static_apertures__";

struct PathState {
  std::string name;
  std::shared_ptr<const PreparedScene> scene;  // without light sources that emit
};

struct LightPath {
  std::string name;  // of a group, or static_path
  std::vector<PathState> states;
};

// Sensors first … first + count - 1, which belong to one room or zone.
struct SensorSpan {
  size_t first = 0, count = 0;
};

// State of every path in every hour of YearSkies.
struct StateSchedule {
  size_t hours = 0;
  std::vector<uint16_t> states;  // path by path

  StateSchedule(size_t paths, size_t hours_of_year)
      : hours(hours_of_year), states(paths * hours_of_year, 0) {}
  std::span<uint16_t> of(size_t path) { return std::span(states).subspan(path * hours, hours); }
  std::span<const uint16_t> of(size_t path) const {
    return std::span(states).subspan(path * hours, hours);
  }
};

// Returns the index of each path's first state in a list of the states of all paths.
std::vector<size_t> first_states(const std::vector<LightPath>& paths);

}  // namespace troffer
