// Direct light at cells, by the direct light of a method or by light samples. Used by
// cell_builder.cpp. The noise of a value depends on the group of cells that is lit together, but
// groups are the same for any number of threads.
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
  std::vector<Rgb> irradiance;         // per cell: mean over its hits, weighted by their coats
  std::vector<float> half_difference;  // luminance: half the difference of the two halves of hits
};

// Computes direct light of all cells from number `first` on; values of earlier cells stay. Cells
// near each other are lit in groups. samples: per cell, the number of light samples of one light
// each, as in path tracing; 0 or missing: by `direct`. group: may be null. Incomplete once `stop`
// is set.
void add_direct_light(const CellMap& map, const GatherWalks& walks, const DirectLight& direct,
                      std::span<const uint8_t> samples, size_t first, int threads,
                      ProcessGroup* group, const StopFlag& stop, CellDirectLight& light,
                      Counters& counters);

// Returns the irradiance straight from sources at each place, weighted by its coat. Incomplete once
// `stop` is set.
std::vector<Rgb> direct_light_at(std::span<const CellHit> places, const GatherWalks& walks,
                                 const DirectLight& direct, int threads, const StopFlag& stop,
                                 Counters& counters);

}  // namespace troffer
