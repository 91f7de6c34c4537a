#include "render/sample_spread.h"

#include <algorithm>
#include <cmath>

#include "base/units.h"

namespace troffer {

namespace {

// What a viewing ray takes before any light is drawn for it, over what is drawn usually.
constexpr double bare_cost = 0.1;
// Where further samples of a pixel may be drawn with an effort divisor above 1, its first ones are
// lit with more care than even those without, which differ by chance so many times as much, in
// variance …
constexpr double chance_of_further = 2;
// … and, where lights are drawn, by so much of the mean's square. Without it they are where
// nothing else is cheaper: where the first ones differ by chance hardly at all, they are not.
constexpr double chance_of_draws = 0.02, least_of_first = 1.0 / 400;

double chance_of(uint32_t effort_divisor, double of_first, double mean, bool are_alike) {
  if (are_alike) return of_first;
  const double drawn =
      effort_divisor == 1 ? std::min(of_first / least_of_first, sqr(mean)) : sqr(mean);
  return effort_divisor * (chance_of_further * of_first + chance_of_draws * drawn);
}

// Samples that are spread over a pixel err by n^-3/4 by what an edge divides, and by n^-1/2 by
// chance of their own, or n^-(1 + evenness)/2 where that is as even.
double count_for(const SampleSpread& s, double chance, double allowed2, double evenness) {
  const double independent = std::pow((chance + s.thin) / allowed2, 1 / (1 + evenness));
  return independent + std::pow(s.placed / allowed2, 2.0 / 3);
}

}  // namespace

SampleNeed least_work(const SampleSpread& spread, double mean, double allowed,
                      const SampleCosts& costs) {
  // Nothing to see by: no light is allowed, none varies.
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
