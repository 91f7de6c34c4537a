// From linear light to 8-bit display values.
// References: [1] Hable, "Filmic Tonemapping Operators", filmicworlds.com, 2010 (the curve of
//   "Uncharted 2": Filmic Tonemapping for Games, GDC 2010).
#pragma once

#include <cstdint>
#include <vector>

#include "image/image.h"

namespace troffer {

enum class ToneMap { none, filmic };

struct Display {
  double exposure_stops = 0;  // light is multiplied by 2^stops first
  ToneMap tone_map = ToneMap::none;
};

// Hable's curve [1] with linear white 11.2 and the light scaled before it such that mid-grey 0.18
// stays 0.18. Rises strictly from (0, 0) to 1 at 3.83, then is clamped to 1; negative gives 0.
float filmic(float linear);

// sRGB bytes, 3 per pixel, row 0 on top: exposure, tone map (none = plain clamp to [0,1]), sRGB
// curve, rounded to the nearest of 255 steps. NaN becomes 0.
std::vector<uint8_t> srgb8(const Image& image, const Display& display = {}, int threads = 0);

}  // namespace troffer
