// Interpolated values of environment images. Used by light/environment_image.h and by importers.
// Radiance in the units of the image.
#pragma once

#include <algorithm>
#include <cmath>

#include "scene/environment_map.h"

namespace troffer {

// Value at a place of the unit square: bilinear between texel centres. Beyond the square's edges
// the sphere continues.
inline Rgb value_at(const EnvironmentMap& map, const Vec2& uv) {
  const float x = uv.x * float(map.width) - 0.5f, y = uv.y * float(map.height) - 0.5f;
  const float x0 = std::floor(x), y0 = std::floor(y);
  const int i = std::clamp(int(x0), -1, map.width - 1), j = std::clamp(int(y0), -1, map.height - 1);
  const auto texel = [&](int dx, int dy) {
    return map.texels[texel_on_sphere(map.projection, map.width, map.height, i + dx, j + dy)];
  };
  const float s = x - x0, t = y - y0;
  return texel(0, 0) * ((1 - s) * (1 - t)) + texel(1, 0) * (s * (1 - t)) +
         texel(0, 1) * ((1 - s) * t) + texel(1, 1) * (s * t);
}

}  // namespace troffer
