#include "radiosity/closure.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace troffer {

OpenShare open_share(double share, double rays, bool is_closed) {
  if (is_closed) return {0, 0};
  // Laplace's rule: with few rays, none may leave by chance. The variance is that of two more rays,
  // one of which leaves.
  const double n = rays + 2, p = (share * rays + 1) / n;
  return {share, 3 * std::sqrt(p * (1 - p) / n)};
}

Closure close_shot(std::span<const float> powers, double sum, double sent, const OpenShare& open) {
  Closure c;
  if (!(sum > 0) || !(sent > 0) || !std::isfinite(sum)) return c;
  c.cap = std::numeric_limits<double>::infinity();
  const double least = sent * std::clamp(1 - open.share - open.error, 0.0, 1.0);
  const double most = sent * std::clamp(1 - open.share + open.error, 0.0, 1.0);
  c.arrived = std::clamp(sum, std::min(least, (1 + most_closure_scale) * sum), most);
  c.scale = c.arrived / sum;
  if (sum <= (1 + most_closure_scale) * most) return c;
  // Bisects for the cap at which the sum is right; the scale corrects the remainder.
  double low = 0, high = sent, capped = 0;
  for (int step = 0; step < 24; ++step) {
    const double cap = 0.5 * (low + high);
    double total = 0;
    for (const float p : powers) total += std::min(double(p), cap);
    if (total > most) {
      high = cap;
    } else {
      low = cap;
      capped = total;
    }
  }
  c.cap = low;
  c.scale = capped > 0 ? std::min(most / capped, 2.0) : 0.0;
  c.arrived = capped * c.scale;
  return c;
}

}  // namespace troffer
