#include "scene/projected_image.h"

#include <cmath>

namespace troffer {

Rgb projected_flux(const Scene& scene, const Light& e) {
  constexpr int n = 256;
  // Half width and half height at distance 1.
  const float a = 1 / length(e.axes[0]), b = 1 / length(e.axes[1]);
  double r = 0, g = 0, blue = 0;
  for (int i = 0; i < n * n; ++i) {
    const float x = 2 * (float(i % n) + 0.5f) / n - 1, y = 2 * (float(i / n) + 0.5f) / n - 1;
    const double d2 = 1 + double(x * a) * double(x * a) + double(y * b) * double(y * b);
    const double solid_angle = 4 * double(a) * double(b) / (n * n) / (d2 * std::sqrt(d2));
    const Rgb value = projected(scene, e, {x, y, 1});
    r += solid_angle * double(value.r);
    g += solid_angle * double(value.g);
    blue += solid_angle * double(value.b);
  }
  return {float(r), float(g), float(blue)};
}

}  // namespace troffer
