// Answers for pairs of receiver and source. CellSum adds up the cells of a source; SourceVisibility
// is the finished answer. All stages of certified visibility write them.
#pragma once

#include <algorithm>
#include <cstdint>

#include "base/rgb.h"

namespace troffer {

// Kind of answer of a pair. below: no light can arrive, since the source is below the horizon or
// the receiver behind the source.
enum class ShadowAnswer : uint8_t { below, lit, dark, masked, mixed };

// The finished answer, including rays.
struct SourceVisibility {
  float unoccluded = 0;      // projected solid angle, sr
  float visible = 0;         // visible share of it
  float variance = 0;        // estimated variance of `visible`
  Rgb value;                 // value of the integrand, if the receiver has one
  float value_variance = 0;  // variance of its luminance
  uint32_t rays = 0;         // rays cast for it
  ShadowAnswer answer = ShadowAnswer::below;
};

constexpr uint8_t answer_bit(ShadowAnswer a) {
  return uint8_t(1u << uint32_t(a));
}

// Sum over the cells of a source, without rays.
struct CellSum {
  float light = 0;       // unoccluded light of a cell × its visible share, sr
  float variance = 0;    // variance of `light`, sr²
  float unoccluded = 0;  // light of the cells that have an answer, sr
  Rgb value;
  float value_variance = 0;
  uint8_t kinds = 0;  // answer_bit of each cell's answer
  uint32_t rays = 0;  // rays cast so far

  void add(float cell_unoccluded, float share, float share_variance, ShadowAnswer kind) {
    light += cell_unoccluded * share;
    variance += cell_unoccluded * cell_unoccluded * share_variance;
    unoccluded += cell_unoccluded;
    kinds = uint8_t(kinds | answer_bit(kind));
  }
};

// Sets `a` to the answer for the whole source, without queued rays. unoccluded: exact value for the
// whole source, to which the sum over cells is scaled. Writes in place, since copying would take as
// long as computing.
inline void set_answer(const CellSum& sum, float unoccluded, SourceVisibility& a) {
  a = {};
  a.unoccluded = unoccluded;
  a.value = sum.value;
  a.value_variance = sum.value_variance;
  a.rays = sum.rays;
  if (sum.kinds == 0 || !(sum.unoccluded > 0)) return;
  if (sum.kinds == answer_bit(ShadowAnswer::lit)) {
    a.visible = 1;
    a.answer = ShadowAnswer::lit;
  } else if (sum.kinds == answer_bit(ShadowAnswer::dark)) {
    a.answer = ShadowAnswer::dark;
  } else {
    const float square = sum.unoccluded * sum.unoccluded;
    a.visible = sum.light / sum.unoccluded;
    if (sum.rays == 0)
      a.visible = std::min(a.visible, 1.0f);              // with rays, clamping would bias the mean
    a.variance = square > 0 ? sum.variance / square : 0;  // squares of tiny lights may be 0
    a.answer = (sum.kinds & answer_bit(ShadowAnswer::mixed)) != 0 ? ShadowAnswer::mixed
                                                                  : ShadowAnswer::masked;
  }
}

// Result of the rays of a pair, in addition to its masks.
struct RayAnswer {
  uint32_t source = 0, member = 0, rays = 0;
  float light = 0;           // open projected solid angle that they found, sr
  float light_variance = 0;  // sr²
  Rgb value;                 // value of an integrand
  float value_variance = 0;  // variance of its luminance
};
// Adds the result of rays to an answer.
inline void add_rays(const RayAnswer& rays, SourceVisibility& a) {
  const float square = a.unoccluded * a.unoccluded;
  a.visible += rays.light / a.unoccluded;
  a.variance += square > 0 ? rays.light_variance / square : 0;
  a.value += rays.value;
  a.value_variance += rays.value_variance;
  a.rays += rays.rays;
}

}  // namespace troffer
