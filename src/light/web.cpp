#include "light/web.h"

#include <algorithm>
#include <cmath>

#include "base/units.h"

namespace troffer {

namespace {

// i with angles[i] <= x <= angles[i + 1], and how far x is between them.
size_t step_of(const std::vector<float>& angles, float x, float& t) {
  const auto above = std::upper_bound(angles.begin() + 1, angles.end() - 1, x);
  const auto i = size_t(above - angles.begin()) - 1;
  const float step = angles[i + 1] - angles[i];
  t = step > 0 ? std::clamp((x - angles[i]) / step, 0.0f, 1.0f) : 0.0f;
  return i;
}

}  // namespace

float intensity(const LightWeb& web, const Vec3& w) {
  const float height = std::atan2(std::sqrt(w.x * w.x + w.y * w.y), w.z);
  constexpr float slack = 1e-5f;
  if (height < web.heights_rad.front() - slack || height > web.heights_rad.back() + slack) return 0;
  float turn = std::atan2(w.y, w.x);
  if (turn < 0) turn += 2 * pi_f;
  float s = 0, t = 0;
  const size_t i = step_of(web.turns_rad, turn, s), j = step_of(web.heights_rad, height, t);
  const size_t n = web.heights_rad.size();
  const float* at = web.intensities.data() + i * n + j;
  return lerp(lerp(at[0], at[1], t), lerp(at[n], at[n + 1], t), s);
}

double flux(const LightWeb& web) {
  const size_t n = web.heights_rad.size();
  double sum = 0;
  for (size_t j = 0; j + 1 < n; ++j) {
    const double a = double(web.heights_rad[j]), b = double(web.heights_rad[j + 1]);
    if (!(b > a)) continue;
    // Of sin over [a, b], and of sin times what grows from 0 to 1 there.
    const double all = std::cos(a) - std::cos(b);
    const double rising = (std::sin(b) - std::sin(a)) / (b - a) - std::cos(b);
    for (size_t i = 0; i + 1 < web.turns_rad.size(); ++i) {
      const float* at = web.intensities.data() + i * n + j;
      const double turn = double(web.turns_rad[i + 1]) - double(web.turns_rad[i]);
      const double low = (double(at[0]) + double(at[n])) / 2;
      const double high = (double(at[1]) + double(at[n + 1])) / 2;
      sum += turn * (low * all + (high - low) * rising);
    }
  }
  return sum;
}

float largest_intensity(const LightWeb& web) {
  return *std::max_element(web.intensities.begin(), web.intensities.end());
}

}  // namespace troffer
