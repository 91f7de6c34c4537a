#include "render/sample_spread.h"

#include <algorithm>
#include <cmath>

#include "base/units.h"

namespace troffer {

namespace {

// Cost of a viewing ray without light sampling, relative to the light sampling of a full one.
constexpr double bare_cost = 0.1;
// Variance of further samples relative to first ones. If an effort divisor above 1 is allowed,
// first samples are computed more carefully than further ones, even those with divisor 1. The
// independent variance of further samples is then larger by this factor.
constexpr double chance_of_further = 2;
// Addition to the independent variance of further samples where lights are sampled, relative to the
// squared mean. At divisor 1 it vanishes as the variance of the first samples does: lights are
// sampled only where nothing else is cheaper.
constexpr double chance_of_draws = 0.02, least_of_first = 1.0 / 400;

double chance_of(uint32_t effort_divisor, double of_first, double mean, bool are_alike) {
  if (are_alike) return of_first;
  const double drawn =
      effort_divisor == 1 ? std::min(of_first / least_of_first, sqr(mean)) : sqr(mean);
  return effort_divisor * (chance_of_further * of_first + chance_of_draws * drawn);
}

// Returns the number of samples for an error. Stratified samples err by n^-3/4 at an edge. They err
// by n^-1/2 due to independent variance, or by n^-(1 + evenness)/2 if that is stratified, too.
double count_for(const SampleSpread& s, double chance, double allowed2, double evenness) {
  const double independent = std::pow((chance + s.thin) / allowed2, 1 / (1 + evenness));
  return independent + std::pow(s.placed / allowed2, 2.0 / 3);
}

}  // namespace

SampleNeed least_work(const SampleSpread& spread, double mean, double allowed,
                      const SampleCosts& costs) {
  // nothing varies, so no estimate is possible
  if (!(spread.chance + spread.placed + spread.thin + spread.clutter > 0)) return {};
  const double allowed2 = sqr(allowed);
  const double as_first = count_for(spread, spread.chance, allowed2, costs.evenness);
  if (as_first <= costs.first && !(spread.clutter > 0)) return {as_first, 1};
  const bool are_alike = costs.most_effort_divisor == 1;
  SampleNeed best;
  double least = 0;
  for (uint32_t effort_divisor = 1; effort_divisor <= costs.most_effort_divisor;
       effort_divisor *= 2) {
    const double chance = chance_of(effort_divisor, spread.chance, mean, are_alike);
    const double amid = spread.clutter + (are_alike ? 0 : chance);
    double n = count_for(spread, chance, allowed2, costs.evenness);
    if (spread.clutter > 0) n = std::max(n, amid / allowed2);
    const double cost = (bare_cost + 1.0 / effort_divisor) / (bare_cost + 1);
    if (costs.most_even > 0 && n * cost > sqr(costs.most_even))
      n = costs.most_even * std::sqrt(n * cost) / cost;
    if (effort_divisor > 1 && !(n * cost < least && n <= costs.most)) continue;
    least = n * cost;
    best = {n, effort_divisor};
  }
  return best;
}

}  // namespace troffer
