// Light straight from sources at cells, by a method's own direct light.
#pragma once

#include <vector>

#include "base/parallel.h"
#include "cells/cell_map.h"
#include "integrate/direct_light.h"

namespace troffer {

struct CellDirectLight {
  std::vector<Rgb> irradiance;         // of each cell, the mean over its hits
  std::vector<float> half_difference;  // luminance: what either half of the hits has more or less
};

// Cells near each other are lit together, in the same groups for any number of threads.
CellDirectLight direct_light_of(const CellMap& map, const DirectLight& direct, int threads,
                                const StopFlag& stop, Counters& counters);

}  // namespace troffer
