// Absorption as files have it.
#pragma once

#include "base/rgb.h"

namespace troffer {

// Per metre, made a number that is not negative.
inline Rgb usable_absorption(Rgb a) {
  const auto usable = [](float v) { return v > 0 ? (v < 1e6f ? v : 1e6f) : 0.0f; };
  return {usable(a.r), usable(a.g), usable(a.b)};
}

}  // namespace troffer
