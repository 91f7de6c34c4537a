#include "image/exposure.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace troffer {

Brightness brightness(const Image& image) {
  constexpr double mid_grey = 0.18;
  std::vector<float> logs;
  logs.reserve(image.pixels.size());
  for (const Rgb& pixel : image.pixels) {
    const float y = luminance(pixel);
    if (y > 0 && std::isfinite(y)) logs.push_back(std::log2(y));
  }
  Brightness b;
  if (logs.empty()) return b;
  b.is_black = false;
  std::sort(logs.begin(), logs.end());
  const size_t cut = logs.size() / 20;
  double sum = 0;
  for (size_t i = cut; i < logs.size() - cut; ++i) sum += double(logs[i]);
  b.auto_stops = std::log2(mid_grey) - sum / double(logs.size() - 2 * cut);
  return b;
}

}  // namespace troffer
