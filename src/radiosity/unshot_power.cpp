#include "radiosity/unshot_power.h"

namespace troffer {

UnshotPower::UnshotPower(const RadiosityMesh& mesh, const Receivers& receivers,
                         const std::vector<PointSurface>& surfaces, EnergyBalance& balance)
    : surfaces_(surfaces),
      balance_(balance),
      unshot_(mesh.patches.size(), Rgb{0}),
      slot_(mesh.points.size(), 0),
      unshot_at_(receivers.slots(), 0.0f) {
  for (const ReceiverBlock& b : receivers.blocks)
    for (uint32_t i = 0; i < b.count; ++i) slot_[b.first_point + i] = b.first_slot + i;
}

void UnshotPower::count(double power, const OpenShare& open, const Closure& closure) {
  balance_.shot += power;
  arrived_ += closure.arrived;
  const double missing = power - closure.arrived;
  const double escaped = std::clamp(missing, power * std::max(0.0, open.share - open.error),
                                    power * std::min(1.0, open.share + open.error));
  balance_.escaped += escaped;
  balance_.unaccounted += missing - escaped;
}

double UnshotPower::sum() const {
  double sums[4] = {};  // four sums for speed: this runs at every shot
  size_t i = 0;
  for (; i + 4 <= unshot_.size(); i += 4)
    for (size_t k = 0; k < 4; ++k) sums[k] += double(luminance(unshot_[i + k]));
  for (; i < unshot_.size(); ++i) sums[0] += double(luminance(unshot_[i]));
  return (sums[0] + sums[1]) + (sums[2] + sums[3]);
}

uint32_t UnshotPower::brightest_patch() const {
  uint32_t brightest = 0;
  float most = 0;
  for (uint32_t i = 0; i < unshot_.size(); ++i) {
    const float l = luminance(unshot_[i]);
    if (l <= most) continue;
    most = l;
    brightest = i;
  }
  return brightest;
}

void UnshotPower::clear(uint32_t patch, const Patch& its_points) {
  unshot_[patch] = Rgb{0};
  const auto first = unshot_at_.begin() + slot_[its_points.first_point];
  std::fill(first, first + (its_points.last_point - its_points.first_point), 0.0f);
}

Rgb UnshotPower::ambient(const MeanSurface& mean) const {
  Rgb sum = lost_;
  for (const Rgb& u : unshot_) sum += u;
  const double stays = balance_.shot > 0 ? std::clamp(arrived_ / balance_.shot, 0.0, 1.0) : 0.0;
  if (!(mean.area > 0)) return {};
  return sum * float(stays / (mean.area * (1 - stays * mean.albedo)));
}

}  // namespace troffer
