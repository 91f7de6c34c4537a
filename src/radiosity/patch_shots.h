// What one patch gives to all sample points by its unshot power, with rows (patch_rows.h) kept from
// shot to shot.
#pragma once

#include <span>
#include <vector>

#include "base/parallel.h"
#include "radiosity/patch_rows.h"
#include "radiosity/solution.h"

namespace troffer {

class PatchShots {
 public:
  // Makes shots for a solution with its mesh, options and mean irradiance.
  PatchShots(const Tracer& tracer, RadiositySolution& solution, int threads);

  // `power`, in proportion to unshot_at (per point of the patch); `radiance` is what it then sends,
  // and counted in the solution. least_listed, per block: what is hidden and would not bring that
  // much importance (stored_list.h) is left out. False, with nothing done, once `stop` is set. A
  // patch without a place to shoot from gives nothing to no point.
  bool shoot(uint32_t patch, const Rgb& power, std::span<const float> unshot_at,
             std::span<const float> least_listed, const StopFlag& stop, Rgb& radiance);
  const Receivers& receivers() const { return rows_.receivers(); }

  // Of the last shot, per unit of radiance.
  const ShotReceived& received() const { return shot_; }
  uint64_t rays() const { return rows_.rays(); }

 private:
  void limit();

  RadiositySolution& solution_;
  PatchRows rows_;
  std::vector<float> seen_;  // sum of form factors to patches that have shot, per slot
  std::vector<uint8_t> has_shot_;
  ShotReceived shot_;
};

}  // namespace troffer
