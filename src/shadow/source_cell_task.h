// One cell of a source against some receivers of a cluster: what the stages that settle it want to
// know.
#pragma once

#include <cstdint>
#include <span>

#include "shadow/coverage_mask.h"
#include "shadow/source_task.h"

namespace troffer {

struct SourceCellTask {
  const SourceTask& source;
  const MaskFrame& frame;
  std::span<const float> unoccluded;  // per receiver of the cluster, of the cell, sr
  uint64_t stream;                    // hash that tells its random numbers from other cells'
  bool is_complete;                   // of the list of facets
  bool is_over_budget;                // lists of this source are too long: masks share the rays

  // Of a list that is not complete all that it lacks; null where that is not known.
  const FacetList* masked = nullptr;

  const ShadowReceiver& receiver(uint32_t member) const { return source.cluster.receivers[member]; }
};

}  // namespace troffer
