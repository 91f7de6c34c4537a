// How many points of far sources each hit of a cluster gets.
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <span>

#include "certified/drawn_lights.h"

namespace troffer {

// In pictures pixels whose viewing rays meet different things err by these, and get further viewing
// rays: neither those nor these get as many points as the error alone would want.
class FarCounts {
 public:
  // of_pixel: points of a pixel, all of its usual viewing rays together; open: the share of the
  // light that arrives; least: points of a hit, if it gets any.
  FarCounts(const WaitingHits& hits, std::span<const uint32_t> members, const DrawingBudget& budget,
            bool is_picture, double of_pixel, double open, double least = 0)
      : hits_(hits),
        members_(members),
        first_(uint32_t(budget.viewing_rays)),
        is_picture_(is_picture) {
    constexpr double most_points = 256;
    if (!(of_pixel > 0)) return;
    const double each = std::clamp(of_pixel / double(budget.viewing_rays), least, most_points);
    usual_ = power_near(each);
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
  // The pixel's hits begin at i.
  void look_at_pixel(size_t i) {
    size_t end = i + 1;
    while (end < members_.size() && !is_first_of_pixel(end)) ++end;
    is_divided_ = 2 * (end - i) <= first_;
  }
  // Points of hit i, and the first of them in the pixel's sequence.
  uint32_t of(size_t i, uint32_t& first_point) const {
    const uint32_t sample = hits_.samples[members_[i]];
    const bool is_further = is_picture_ && sample >= first_;
    first_point = is_further ? first_ * usual_ + (sample - first_) * few_ : sample * usual_;
    return is_further || (is_picture_ && is_divided_) ? few_ : usual_;
  }

 private:
  // Of two, which sequences are even for: the nearest in ratio. None for nothing.
  static uint32_t power_near(double n) {
    return n > 0 ? std::bit_floor(std::max(uint32_t(n * std::sqrt(2.0)), 1u)) : 0;
  }

  const WaitingHits& hits_;
  std::span<const uint32_t> members_;
  uint32_t first_, usual_ = 0, few_ = 0;
  bool is_picture_, is_divided_ = false;
};

}  // namespace troffer
