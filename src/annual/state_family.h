// States whose scenes differ in few places, such as those of all window groups of a building. They
// share what does not depend on their differences: cells, rows, and rays that meet none of their
// regions (ray_regions.h).
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "annual/ray_regions.h"
#include "cells/cell_hit.h"
#include "transport/prepared_scene.h"

namespace troffer {

struct StateOfFamily {
  size_t number = 0;  // in the list of all states
  std::shared_ptr<const PreparedScene> scene;
  size_t region = 0;  // where it differs from the first state; the first state has none
};

struct StateFamily {
  std::vector<StateOfFamily> states;  // at least one; the others are compared with its scene
  std::vector<CellHit> sensors;       // in the scenes of all states
  RayRegions regions;
};

// A state to be assigned to a family.
struct SceneOfState {
  std::shared_ptr<const PreparedScene> scene;
  std::span<const CellHit> sensors;
  size_t path = 0;  // states of one path have one region
};

// Forms families of the given states. States that cannot be compared, or in which the sensors have
// other places, form families of their own.
std::vector<StateFamily> state_families(std::span<const SceneOfState> states);

}  // namespace troffer
