// Choosing a step of a piecewise constant distribution by inversion. A guide table says where the
// search for a random number begins, so a search takes two steps on average, for any number of
// steps of the distribution. Used by DirectionTable.
//
// References: [1] Chen and Asau, "On Generating Random Variates from an Empirical Distribution",
//   AIIE Transactions 6(2), 1974.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace troffer {

// Sets cdf to the running sums of `weights` over their total, weights.size() + 1 numbers from 0 to
// 1. Returns the total. If it is 0, all numbers but the first are 1.
double fill_cdf(const std::vector<double>& weights, float* cdf);

// Sets guide[k] to the step of the cdf that holds k / n, for k below n, its number of steps.
void fill_guide(const float* cdf, size_t n, uint32_t* guide);

// Returns the index i with cdf[i] <= u < cdf[i + 1] for u in [0,1), and rescales u to that step. A
// step of weight 0 is never chosen. guide: as filled by fill_guide().
int choose_step(const float* cdf, const uint32_t* guide, size_t n, float& u);

}  // namespace troffer
