// Light straight from sources at cells, by a method's own direct light.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/process_group.h"
#include "cells/cell_map.h"
#include "gather/gather_walks.h"
#include "transport/direct_light.h"

namespace troffer {

struct CellDirectLight {
  std::vector<Rgb> irradiance;  // of each cell, the mean over its hits, by way of their coats
  std::vector<float> half_difference;  // luminance: what either half of the hits has more or less
};

// Of all cells from number `first` on; what is in `light` of those before stays. Cells near each
// other are lit together, in the same groups for any number of threads. samples: of each cell, by
// so many draws of one source each, as in path tracing; by `direct` where it is 0.
// crew: may be null. Not all of them once `stop` is set.
void add_direct_light(const CellMap& map, const GatherWalks& walks, const DirectLight& direct,
                      std::span<const uint8_t> samples, size_t first, int threads,
                      ProcessGroup* group, const StopFlag& stop, CellDirectLight& light,
                      Counters& counters);

// Light straight from sources at any places, by way of their coats: irradiance of each. Not all of
// them once `stop` is set.
std::vector<Rgb> direct_light_at(std::span<const CellHit> places, const GatherWalks& walks,
                                 const DirectLight& direct, int threads, const StopFlag& stop,
                                 Counters& counters);

}  // namespace troffer
