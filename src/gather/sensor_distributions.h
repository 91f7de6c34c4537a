// Guides gather rays of sensors to lit regions (lit_regions.h), for CellsIndirect. The visibility
// of regions is tested by rays, too, so sensors with few rays share the tests.
#pragma once

#include <cstddef>
#include <vector>

#include "cells/cell_hit.h"
#include "gather/lit_regions.h"
#include "transport/batch.h"

namespace troffer {

CellHit hit_of(const SensorBatch& sensors, size_t i);

class SensorDistributions {
 public:
  // Starts a batch. Consecutive sensors of one stream belong together: at one place (measuring), or
  // spread over a small patch (baking). Places and sensors must outlive the calls of at().
  void begin(const LitRegions& places, const SensorBatch& sensors);
  // Returns the distribution of sensor i. Call it in ascending order of i. The result does not
  // depend on other batches.
  const GatherDistribution& at(size_t i);

 private:
  void look_from_patches();

  const LitRegions* places_ = nullptr;
  const SensorBatch* sensors_ = nullptr;
  size_t end_ = 0;  // one past the last sensor that aim_ serves
  GatherDistribution aim_;
  // Place of aim_, if it is for one place.
  CellHit place_;
  bool is_for_place_ = false;
  // Visibility from all patches of the batch together.
  RegionVisibility sight_;
  bool has_sight_ = false;
};

}  // namespace troffer
