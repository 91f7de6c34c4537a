#include "render/sample_spread.h"

#include <algorithm>
#include <cmath>

#include "base/units.h"

namespace troffer {

double samples_for(const SampleSpread& s, double allowed, double most_even, double evenness) {
  const double allowed2 = sqr(allowed);
  if (!(s.chance + s.placed + s.thin + s.clutter > 0)) return 0;
  double n = std::pow((s.chance + s.thin) / allowed2, 1 / (1 + evenness)) +
             std::pow(s.placed / allowed2, 2.0 / 3);
  n = std::max(n, s.clutter / allowed2);
  if (most_even > 0 && n > sqr(most_even)) n = most_even * std::sqrt(n);
  return n;
}

}  // namespace troffer
