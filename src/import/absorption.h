// Absorption coefficients from files, made usable. Used by the importers of pbrt and Mitsuba for
// the media inside glass. Coefficients are per metre.
#pragma once

#include "base/rgb.h"

namespace troffer {

// Clamps a coefficient, per metre, to [0, 1e6]; NaN becomes 0.
inline Rgb usable_absorption(Rgb a) {
  const auto usable = [](float v) { return v > 0 ? (v < 1e6f ? v : 1e6f) : 0.0f; };
  return {usable(a.r), usable(a.g), usable(a.b)};
}

}  // namespace troffer
