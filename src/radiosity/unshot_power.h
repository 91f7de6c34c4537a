// Unshot power of the patches, and the energy balance of light that arrives. The solver passes on
// the light of each shot and obtains from it the next patch to shoot. Power is in W or lm.
#pragma once

#include <algorithm>
#include <span>
#include <vector>

#include "radiosity/closure.h"
#include "radiosity/point_lanes.h"
#include "radiosity/point_surfaces.h"
#include "radiosity/solution.h"

namespace troffer {

class UnshotPower {
 public:
  UnshotPower(const RadiosityMesh& mesh, const Receivers& receivers,
              const std::vector<PointSurface>& surfaces, EnergyBalance& balance);

  // Passes on light at a point. `power` is the luminance of `received` over the point's element,
  // before closure.
  void pass_on(uint32_t point, const Rgb& received, float power, const Closure& closure);
  // The same for the points of one block, whose `radiosity` is already updated.
  void pass_on(const ReceiverBlock& block, const BlockArrival& arrival, const Rgb& tint);
  float* radiosity(const ReceiverBlock& block) { return unshot_at_.data() + block.first_slot; }
  // Counts a shot of this power: the part that left the scene and the part unaccounted for.
  void count(double power, const OpenShare& open, const Closure& closure);

  double sum() const;  // luminance
  uint32_t brightest_patch() const;
  const Rgb& of(uint32_t patch) const { return unshot_[patch]; }
  // Luminance of radiosity per point of the patch, in any unit.
  std::span<const float> at_points_of(const Patch& patch) const {
    return {unshot_at_.data() + slot_[patch.first_point], patch.last_point - patch.first_point};
  }
  void clear(uint32_t patch, const Patch& its_points);

  // Returns the ambient estimate [1] of solver.h, §3: unshot power spreads over all surfaces and is
  // reflected repeatedly. It includes power that mirrors, glass and gloss received, which do not
  // shoot. At each bounce the same share leaves an open scene as left it from the shots.
  Rgb ambient(const MeanSurface& mean) const;

 private:
  const std::vector<PointSurface>& surfaces_;
  EnergyBalance& balance_;
  std::vector<Rgb> unshot_;       // power, per patch
  std::vector<uint32_t> slot_;    // per point
  std::vector<float> unshot_at_;  // luminance of radiosity, per slot
  Rgb lost_;                      // power that specular surfaces received
  double arrived_ = 0;
};

inline void UnshotPower::pass_on(uint32_t point, const Rgb& received, float power,
                                 const Closure& closure) {
  if (!(power > 0)) return;
  const PointSurface& surface = surfaces_[point];
  const float counted = closure.of(power);
  const Rgb arrived = received * (counted * surface.area / power);
  const Rgb reflected = arrived * surface.reflectance;
  const float passed = luminance(reflected);
  float rest = std::max(counted - passed, 0.0f);
  if (surface.has_specular) {
    const Rgb taken = arrived * surface.specular;
    balance_.lost_to_specular += double(luminance(taken));
    rest -= luminance(taken);
    lost_ += taken;
  }
  balance_.absorbed += double(rest);
  unshot_[surface.patch] += reflected;
  unshot_at_[slot_[point]] += passed * surface.per_area;
}

inline void UnshotPower::pass_on(const ReceiverBlock& block, const BlockArrival& arrival,
                                 const Rgb& tint) {
  const Rgb reflected = tint * arrival.reflected, taken = tint * arrival.specular;
  balance_.lost_to_specular += double(luminance(taken));
  lost_ += taken;
  balance_.absorbed +=
      double(std::max(arrival.counted - luminance(reflected) - luminance(taken), 0.0f));
  unshot_[block.patch] += reflected;
}

}  // namespace troffer
