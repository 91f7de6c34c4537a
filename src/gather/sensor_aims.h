// How rays that gather light at sensors are aimed at bright places (bright_places.h). What is seen
// of these is found out by rays as well, so that sensors which ask for few rays share it.
#pragma once

#include <cstddef>
#include <vector>

#include "cells/cell_hit.h"
#include "gather/bright_places.h"
#include "transport/batch.h"

namespace troffer {

CellHit hit_of(const SensorBatch& sensors, size_t i);

class SensorAims {
 public:
  // Sensors of one stream that follow each other belong together: at one place, as where light is
  // measured, or spread over a small patch, as where it is baked. Places and sensors must outlive
  // what is asked of them.
  void begin(const BrightPlaces& places, const SensorBatch& sensors);
  // Of sensor i, which is not before the one that was asked for last. The same whatever was asked
  // for in other batches.
  const GatherAim& at(size_t i);

 private:
  void look_from_patches();

  const BrightPlaces* places_ = nullptr;
  const SensorBatch* sensors_ = nullptr;
  size_t end_ = 0;  // of the sensors that aim_ is for
  GatherAim aim_;
  // That aim_ is for, if it is for one place.
  CellHit place_;
  bool is_for_place_ = false;
  // What patches see, all of the batch together.
  BrightSight sight_;
  bool has_sight_ = false;
};

}  // namespace troffer
