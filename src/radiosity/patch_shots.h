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
  // and counted in the solution. False, with nothing done, once `stop` is set. A patch without a
  // place to shoot from gives nothing to no point.
  bool shoot(uint32_t patch, const Rgb& power, std::span<const float> unshot_at,
             const StopFlag& stop, Rgb& radiance);

  // Of the last shot, per point and unit of radiance; only of points that are visited.
  float unoccluded(uint32_t point) const { return shot_.unoccluded[point]; }
  float received(uint32_t point) const { return shot_.received[point]; }
  template <class Visit>
  void for_each_point(const Visit& visit) const {
    for (const uint32_t b : shot_.blocks) {
      const ReceiverBlock& block = rows_.blocks()[b];
      for (uint32_t i = 0; i < block.count; ++i) visit(block.first_point + i);
    }
  }
  // A point sees no more than a hemisphere. Where it does, as before surfaces of several meshes
  // that coincide or nearly do, patches give it so much less. Once for each point of a shot.
  void limit(uint32_t point) {
    constexpr float most = 1.03f;  // an error of form factors is not cut
    if (seen_[point] <= most) return;
    shot_.unoccluded[point] *= most / seen_[point];
    shot_.received[point] *= most / seen_[point];
  }
  uint64_t rays() const { return rows_.rays(); }

 private:
  RadiositySolution& solution_;
  PatchRows rows_;
  std::vector<float> seen_;  // sum of form factors to patches that have shot, per point
  std::vector<uint8_t> has_shot_;
  ShotReceived shot_;
};

}  // namespace troffer
