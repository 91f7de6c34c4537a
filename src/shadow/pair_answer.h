// How much of a source a receiver sees: the answer for a pair of the two, and the sum over the
// source's cells that it is made of.
#pragma once

#include <algorithm>
#include <cstdint>

#include "base/rgb.h"

namespace troffer {

// How a pair was answered. below: no light can arrive, the source is behind the horizon or the
// receiver behind the source.
enum class ShadowAnswer : uint8_t { below, lit, dark, masked, mixed };

// The finished answer, rays included.
struct SourceVisibility {
  float unoccluded = 0;      // projected solid angle, sr
  float visible = 0;         // share of it that is not hidden
  float variance = 0;        // of `visible`, estimated
  Rgb value;                 // of the integrand, where the receiver has one
  float value_variance = 0;  // of its luminance
  uint32_t rays = 0;         // that it took
  ShadowAnswer answer = ShadowAnswer::below;
};

constexpr uint8_t answer_bit(ShadowAnswer a) {
  return uint8_t(1u << uint32_t(a));
}

// What the cells of a source come to without rays.
struct CellSum {
  float light = 0;       // unoccluded light of a cell × its visible share, sr
  float variance = 0;    // of `light`, sr²
  float unoccluded = 0;  // light of the cells that have an answer, sr
  Rgb value;
  float value_variance = 0;
  uint8_t kinds = 0;  // a bit for each answer of a cell
  uint32_t rays = 0;  // cast already

  void add(float cell_unoccluded, float share, float share_variance, ShadowAnswer kind) {
    light += cell_unoccluded * share;
    variance += cell_unoccluded * cell_unoccluded * share_variance;
    unoccluded += cell_unoccluded;
    kinds = uint8_t(kinds | answer_bit(kind));
  }
};

// Makes `a` the whole source's answer, but for rays; unoccluded: exact, of the whole source, to
// which the sum over cells is scaled. Written where it stays: copying it takes as long as making
// it.
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
    if (sum.rays == 0) a.visible = std::min(a.visible, 1.0f);  // of rays the mean would suffer
    a.variance = square > 0 ? sum.variance / square : 0;  // squares of tiny lights are none
    a.answer = (sum.kinds & answer_bit(ShadowAnswer::mixed)) != 0 ? ShadowAnswer::mixed
                                                                  : ShadowAnswer::masked;
  }
}

// What rays of a pair found beyond its masks.
struct RayAnswer {
  uint32_t source = 0, member = 0, rays = 0;
  float light = 0;           // projected solid angle that they found open, sr
  float light_variance = 0;  // sr²
  Rgb value;                 // of an integrand
  float value_variance = 0;  // of its luminance
};
inline void add_rays(const RayAnswer& rays, SourceVisibility& a) {
  const float square = a.unoccluded * a.unoccluded;
  a.visible += rays.light / a.unoccluded;
  a.variance += square > 0 ? rays.light_variance / square : 0;
  a.value += rays.value;
  a.value_variance += rays.value_variance;
  a.rays += rays.rays;
}

}  // namespace troffer
