// Transfers of one patch's unshot power to all sample points. The solver uses it for every shot of
// a patch. Rows (patch_rows.h) are kept from shot to shot, up to a limit of memory.
#pragma once

#include <span>
#include <vector>

#include "base/parallel.h"
#include "radiosity/patch_rows.h"
#include "radiosity/solution.h"

namespace troffer {

class PatchShots {
 public:
  // Prepares shots for a solution, using its mesh, options and mean irradiance.
  PatchShots(const Tracer& tracer, RadiositySolution& solution, int threads);

  // Shoots `power` from a patch, distributed in proportion to unshot_at (per point of the patch).
  // Sets `radiance` to the radiance that this takes and adds it to the solution. Hidden blocks
  // whose importance (stored_list.h) is below least_listed (per block) are left out. Returns false
  // and does nothing once `stop` is set. A patch without area gives nothing to any point.
  bool shoot(uint32_t patch, const Rgb& power, std::span<const float> unshot_at,
             std::span<const float> least_listed, const StopFlag& stop, Rgb& radiance);
  const Receivers& receivers() const { return rows_.receivers(); }

  // Irradiance of the last shot, per unit of radiance.
  const ShotReceived& received() const { return shot_; }
  uint64_t rays() const { return rows_.rays(); }

 private:
  void limit();

  RadiositySolution& solution_;
  PatchRows rows_;
  std::vector<float> seen_;  // per slot: sum of form factors to patches that have shot
  std::vector<uint8_t> has_shot_;
  ShotReceived shot_;
};

}  // namespace troffer
