// Converts linear light to 8-bit display values: exposure, optional filmic curve, sRGB encoding.
// PNG output and image comparison use it.
// References: [1] Hable, "Filmic Tonemapping Operators", filmicworlds.com, 2010 (the curve of
//   "Uncharted 2": Filmic Tonemapping for Games, GDC 2010).
#pragma once

#include <cstdint>
#include <vector>

#include "image/image.h"

namespace troffer {

enum class ToneMap { none, filmic };

struct Display {
  double exposure_stops = 0;  // light is first multiplied by 2^stops
  ToneMap tone_map = ToneMap::none;
};

// Hable's curve [1] with linear white 11.2, scaled so that mid-grey 0.18 stays 0.18. It rises
// strictly from (0, 0) to 1 at 3.83 and is clamped to 1 beyond; negative values give 0.
float filmic(float linear);

// Returns sRGB bytes, 3 per pixel, row 0 on top. Applies exposure, tone map (none: clamp to [0,1])
// and the sRGB curve, and rounds to the nearest byte. NaN becomes 0.
std::vector<uint8_t> srgb8(const Image& image, const Display& display = {}, int threads = 0);

}  // namespace troffer
