// Solves the balance of light in a room, E = D + W E. E and D are irradiance of cells, in any unit;
// W carries light from cell to cell. Used by cell_rows.cpp.
//
// References: [1] Eisenstat, Elman & Schultz, "Variational Iterative Methods for Nonsymmetric
// Systems of Linear Equations", SIAM J. Numer. Anal. 20(2), 1983 (ORTHOMIN).
#pragma once

#include <functional>
#include <vector>

#include "base/rgb.h"

namespace troffer {

// Sets out = W v, of the same length. A solve may call it some hundred times.
using LightOperator = std::function<void(const std::vector<Rgb>& v, std::vector<Rgb>& out)>;

struct Balance {
  std::vector<Rgb> light;  // E
  int iterations = 0;      // applications of W
};

// Solves E = D + W E, each channel by itself. Ends when the residual is at most `most_left` of E,
// both summed over all entries by their weights, or after `most_iterations`. W need not be
// symmetric.
// weights: as many as D. If they are the importance y = c + Wᵀ y of what c asks for, c E errs by y
// times the residual.
//
// The method is generalised conjugate residuals [1] in the inner product by weights. The weighted
// sum of squares of the residual never grows. Where reflectances are near one, a few dozen steps do
// what would take hundreds of bounces.
//
// It converges where I - W is positive real in that product, which holds for importance. No row of
// W sums to more than r < 1, so max |W v| <= r max |v|. And Wᵀ y <= y, so Σ y |W v| <= Σ y |v|.
// Between the two norms Σ y (W v)² <= r Σ y v² (Riesz and Thorin). Without weights it need not
// hold, because many cells may see one. The proof is for one channel's W, but y is by luminance. If
// steps stall after all, some plain bounces follow.
Balance solve_balance(const LightOperator& w, const std::vector<Rgb>& d,
                      const std::vector<float>& weights, double most_left, int most_iterations,
                      int threads);

}  // namespace troffer
