// Solving the balance of light in a room, E = D + W E.
#pragma once

#include <functional>
#include <vector>

#include "base/rgb.h"

namespace troffer {

// out = W v, of the same length; may be called some hundred times.
using LightOperator = std::function<void(const std::vector<Rgb>& v, std::vector<Rgb>& out)>;

struct Balance {
  std::vector<Rgb> light;  // E
  int iterations = 0;      // how often W was applied
};

// Solves E = D + W E, every channel by itself, until what does not balance, summed over all entries
// by their weights, is at most `most_left` of the same sum of E, or after `most_iterations`.
// `weights`, as many as D: if they are the importance y = c + Wᵀ y of what c asks for, then c E is
// off by y times what does not balance. W need not be symmetric; I - W should be positive real, as
// where every row of W sums to less than one. Generalised conjugate residuals [1]: the sum of
// squares of what does not balance never grows, and where reflectances are near one, so that bounce
// after bounce would take hundreds, a few dozen do. [1] Eisenstat, Elman & Schultz, "Variational
// Iterative Methods for Nonsymmetric Systems of Linear Equations", SIAM J. Numer. Anal. 20(2), 1983
// (ORTHOMIN).
Balance solve_balance(const LightOperator& w, const std::vector<Rgb>& d,
                      const std::vector<float>& weights, double most_left, int most_iterations,
                      int threads);

}  // namespace troffer
