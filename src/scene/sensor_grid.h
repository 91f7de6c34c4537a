// Measuring points that a scene file brings along, such as the sensor grids of Honeybee models.
// `troffer measure` uses them.
#pragma once

#include <string>
#include <vector>

#include "base/vec.h"

namespace troffer {

struct SensorGrid {
  std::string name;
  std::string room;              // name of the room it belongs to; empty: none
  std::vector<Vec3d> positions;  // in the file's coordinates, metres
  std::vector<Vec3> directions;  // normal of each sensor
};

// Parts of a scene that change together between states, such as blinds. The scene shows one state.
struct DynamicGroup {
  std::string name;
  std::vector<std::string> states;  // what each state shows
  size_t shown = 0;                 // index of the state in the scene
  bool has_windows = false;         // light enters by apertures or doors of the group
};

}  // namespace troffer
