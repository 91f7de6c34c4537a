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
// off by y times what does not balance. W need not be symmetric. Generalised conjugate residuals
// [1] in the inner product by weights: the weighted sum of squares of what does not balance never
// grows, and where reflectances are near one, so that bounce after bounce would take hundreds, a
// few dozen do. They cannot get stuck where I - W is positive real in that product. It is: no row
// of W sums to more than r < 1, so max |W v| <= r max |v|; and Wᵀ y <= y, so Σ y |W v| <= Σ y |v|;
// between the two norms Σ y (W v)² <= r Σ y v² (Riesz and Thorin). (Without weights it need not be:
// many cells may see one.) That is for one channel's W; y is by luminance, so should they get stuck
// after all, some bounces are taken one by one. [1] Eisenstat, Elman & Schultz, "Variational
// Iterative Methods for Nonsymmetric Systems of Linear Equations", SIAM J. Numer. Anal. 20(2), 1983
// (ORTHOMIN).
Balance solve_balance(const LightOperator& w, const std::vector<Rgb>& d,
                      const std::vector<float>& weights, double most_left, int most_iterations,
                      int threads);

}  // namespace troffer
