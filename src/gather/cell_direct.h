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

// Inputs for the direct light of cells. Results are incomplete once `stop` is set.
struct CellLighting {
  const GatherWalks& walks;
  const DirectLight& direct;
  const StopFlag& stop;
  uint64_t seed = 0;
  int threads = 0;                // 0: all cores
  ProcessGroup* group = nullptr;  // processes that light the same cells together; may be null
};

// Computes direct light of all cells from number `first` on; values of earlier cells stay. Cells
// near each other are lit in groups. samples: per cell, the number of light samples of one light
// each, as in path tracing; 0 or missing: by CellLighting::direct.
void add_direct_light(const CellMap& map, const CellLighting& by, std::span<const uint16_t> samples,
                      size_t first, CellDirectLight& light, Counters& counters);

// Accuracy and cost that are asked of cells' direct light.
struct CellLightNeed {
  double error = 0;  // relative to the root mean square of that light
  double rays = 0;   // budget for all cells, in rays
};
// Returns the number of light samples per cell that meet the error, if they cost less than
// CellLighting::direct, or if that exceeds the budget; 0 otherwise. Samples are limited by the
// budget, too. Tests both ways at a few groups of cells.
uint32_t samples_instead_of_proofs(const CellMap& map, const CellLighting& by,
                                   const CellLightNeed& need, Counters& counters);

// Returns the irradiance straight from sources at each place, weighted by its coat. This process
// alone lights them.
std::vector<Rgb> direct_light_at(std::span<const CellHit> places, const CellLighting& by,
                                 Counters& counters);

}  // namespace troffer
