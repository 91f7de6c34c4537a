#include "light/guide_table.h"

#include <algorithm>

namespace troffer {

double fill_cdf(const std::vector<double>& weights, float* cdf) {
  double total = 0;
  for (const double w : weights) total += w;
  double sum = 0;
  cdf[0] = 0;
  for (size_t i = 0; i < weights.size(); ++i) {
    sum += weights[i];
    cdf[i + 1] = total > 0 ? float(sum / total) : 1.0f;
  }
  // A last step of weight zero must have zero width in spite of rounding.
  for (size_t i = weights.size(); i > 0 && total > 0; --i) {
    cdf[i] = 1;
    if (weights[i - 1] > 0) break;
  }
  return total;
}

void fill_guide(const float* cdf, size_t n, uint32_t* guide) {
  size_t i = 0;
  for (size_t k = 0; k < n; ++k) {
    while (i + 1 < n && cdf[i + 1] <= float(k) / float(n)) ++i;
    guide[k] = uint32_t(i);
  }
}

int choose_step(const float* cdf, const uint32_t* guide, size_t n, float& u) {
  size_t i = guide[std::min(size_t(u * float(n)), n - 1)];
  while (i > 0 && cdf[i] > u) --i;
  while (i + 1 < n && cdf[i + 1] <= u) ++i;
  const float step = cdf[i + 1] - cdf[i];
  u = step > 0 ? std::clamp((u - cdf[i]) / step, 0.0f, 1.0f) : 0.0f;
  return int(i);
}

}  // namespace troffer
