// Costs of work. The unit is the time of tracing one ray and adding the light that it finds.
// Choices between ways of computing the same light compare such costs. They never measure time, so
// they are the same on every machine. `bench/costs` measures the costs again.
#pragma once

#include "transport/batch.h"

namespace troffer {

// Costs of a shadow ray, of a surrogate sample, and of what a ray of a cell's row takes besides the
// ray. Rounded from fits of bench/costs to seven scenes, which gave .24 to .56, 0 to .63 and 1.35.
constexpr double cost_of_shadow_ray = 0.3, cost_of_surrogate = 0.5, cost_of_cell_ray = 1.35;
// The costs of proofs that follow are older than bench/costs, whose fits cannot tell them apart.
// Costs of one mask, of one facet in a mask, and of one point on a source.
constexpr double cost_of_mask = 0.3, cost_of_mask_facet = 1.0 / 12, cost_of_point = 0.3;
// Costs of one pair of a cluster and a source, and of one pair of a hit and a source.
constexpr double cost_of_cluster = 12, cost_of_pair = 0.15;

// Returns the cost of counted rays and masks, in rays.
inline double cost_of_rays_and_masks(const Counters& n) {
  return double(n.viewing_rays + n.extension_rays) + cost_of_shadow_ray * double(n.shadow_rays) +
         cost_of_surrogate * double(n.surrogates) + cost_of_mask * double(n.masks) +
         cost_of_mask_facet * double(n.mask_facets) + cost_of_point * double(n.points);
}
// Returns the cost of all counted work, in rays. Sources proved dark for whole clusters cost
// nothing per hit.
inline double cost_of(const Counters& n) {
  return cost_of_rays_and_masks(n) + cost_of_cluster * double(n.clusters) +
         cost_of_pair * double(n.lit_certified + n.masked + n.mixed);
}

}  // namespace troffer
