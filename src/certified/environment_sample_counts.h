// Numbers of environment light samples for the hits of a cluster. cast_environment_rays() and
// sample_open_parts() use them.
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <span>

#include "certified/drawn_lights.h"

namespace troffer {

// Returns the mean light at the hits, in luminance × sr, for which their pixels show the luminance
// `typical`. Weaker light is allowed the same absolute error as this (allowed_error.h).
inline double typical_light(const WaitingHits& hits, std::span<const uint32_t> members,
                            double typical) {
  if (!(typical > 0)) return 0;
  double weight = 0;
  for (const uint32_t m : members) weight += double(luminance(hits.weights[m]));
  return weight > 0 ? typical * double(members.size()) / weight : 0;
}

// Shares a pixel's samples among its hits. In pictures, a pixel's further viewing rays, and those
// of pixels that show several things, get fewer samples: such pixels err mostly by what they show.
class EnvironmentSampleCounts {
 public:
  // of_pixel: samples for all usual viewing rays of a pixel together. open: share of the light that
  // arrives. least: fewest samples of a hit that gets any.
  EnvironmentSampleCounts(const WaitingHits& hits, std::span<const uint32_t> members,
                          const DrawingBudget& budget, double of_pixel, double open,
                          double least = 0)
      : hits_(hits),
        members_(members),
        first_(uint32_t(budget.viewing_rays)),
        is_picture_(budget.typical > 0) {
    constexpr double most_points = 256;
    if (!(of_pixel > 0)) return;
    const double each = std::clamp(of_pixel / double(budget.viewing_rays), least, most_points);
    usual_ = power_near(each);
    // At most `most_fewer` times fewer samples, and `least_most_few` per hit, once the share `much`
    // arrives.
    constexpr double most_fewer = 4, least_most_few = 8, much = 0.4;
    const double fewer = std::clamp(most_fewer * open / much, 1.0, most_fewer);
    const double most_few = least_most_few * sqr(most_fewer / fewer);
    few_ = std::min(power_near(std::clamp(each / fewer, least, std::max(most_few, least))), usual_);
    if (few_ > 0) few_ = std::max(few_ / budget.effort_divisor, 1u);
  }

  uint32_t usual() const { return usual_; }
  bool is_first_of_pixel(size_t i) const {
    return i == 0 || hits_.pixels[members_[i]] != hits_.pixels[members_[i - 1]];
  }
  // Starts the pixel whose hits begin at i.
  void look_at_pixel(size_t i) {
    size_t end = i + 1;
    while (end < members_.size() && !is_first_of_pixel(end)) ++end;
    is_divided_ = 2 * (end - i) <= first_;
  }
  // Returns the number of samples of hit i, and the index of the first of them in the pixel's
  // sequence.
  uint32_t of(size_t i, uint32_t& first_point) const {
    const uint32_t sample = hits_.samples[members_[i]];
    const bool is_further = is_picture_ && sample >= first_;
    first_point = is_further ? first_ * usual_ + (sample - first_) * few_ : sample * usual_;
    return is_further || (is_picture_ && is_divided_) ? few_ : usual_;
  }

 private:
  // Returns the power of two nearest in ratio, at least 1, because Sobol sequences are balanced for
  // those; 0 for n = 0.
  static uint32_t power_near(double n) {
    return n > 0 ? std::bit_floor(std::max(uint32_t(n * std::sqrt(2.0)), 1u)) : 0;
  }

  const WaitingHits& hits_;
  std::span<const uint32_t> members_;
  uint32_t first_, usual_ = 0, few_ = 0;
  bool is_picture_, is_divided_ = false;
};

}  // namespace troffer
