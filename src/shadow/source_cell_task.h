// One source cell and some receivers of a cluster: the input of the stages that settle the cell.
#pragma once

#include <cstdint>
#include <span>

#include "shadow/coverage_mask.h"
#include "shadow/source_task.h"

namespace troffer {

// Input of settle_cell and of the masks; refers to data of the caller.
struct SourceCellTask {
  const SourceTask& source;
  const MaskFrame& frame;
  std::span<const float>
      unoccluded;       // unoccluded light of the cell, per receiver of the cluster, sr
  uint64_t stream;      // hash that is unique to the cell, for random numbers
  bool is_complete;     // whether the facet list is complete
  bool is_over_budget;  // lists of this source are too long, so several masks share the rays

  // All occluders that an incomplete list lacks; null if they are not known.
  const FacetList* masked = nullptr;

  const ShadowReceiver& receiver(uint32_t member) const { return source.cluster.receivers[member]; }
};

}  // namespace troffer
