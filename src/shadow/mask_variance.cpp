#include "shadow/mask_variance.h"

#include <algorithm>
#include <cmath>

#include "base/simd.h"

namespace troffer {

namespace {

// Returns the variance of the count of lattice samples behind an edge, in samples² per pair of
// neighbours that the edge separates. The ratio of pairs in rows and in columns gives the edge's
// direction. The variance is large along rows and columns, and along lines through every second
// sample (measured: docs/results/certified.md, "The lattice"). Equal numbers usually mean edges
// along both sides of the source, not diagonals.
float edge_variance(float least_pairs, float most_pairs) {
  if (most_pairs < 6) return 0.14f;  // too few pairs for a direction
  const float ratio = least_pairs / most_pairs;
  if (ratio < 0.04f) return 0.5f;
  return ratio < 0.08f || std::abs(ratio - 0.5f) < 0.06f || ratio > 0.9f ? 0.075f : 0.045f;
}

// Factor for occluders in rows, such as parallel wires, which may be in step with the samples.
constexpr float regularity = 1.2f;

// Returns the variance of a share if samples were random and `random` pairs would differ.
float random_variance(float n, float spread, float random) {
  return regularity * n * spread * n / ((n - 1) * random);
}

// Returns how much weights vary along a side: half their difference between the ends of a line,
// over the mean there. Of two lines, the one with more weight counts.
float variation_along(const MaskLattice& lattice, const MaskWeights& w, EdgesAlong edges) {
  const auto a = float(lattice.a), b = float(lattice.b), middle = 0.5f * (a + b);
  const Vec2 u{a, -b}, v{b, a};
  const Vec2 along = (edges == EdgesAlong::v ? v : u) * 0.5f;
  const Vec2 across = (edges == EdgesAlong::v ? u : v) * 0.33f;
  float most = 0, variation = 1;
  for (const float side : {-1.0f, 1.0f}) {
    const Vec2 from = Vec2{middle, middle} + across * side - along, to = from + along * 2.0f;
    const float first = weight_of(w, from.x, from.y), last = weight_of(w, to.x, to.y);
    if (!(first + last > most)) continue;
    most = first + last;
    variation = std::abs(first - last) / most;
  }
  return variation;
}

// Returns the variance of the share, in squared weights of samples, for edges along one side of the
// source.
//
// Each edge separates one pair of samples that are consecutive across it. The count behind a single
// edge at a random place x has the variance f (1 - f), f the fraction of n x: 1/6 sample² on
// average. Both edges of a bar together have that variance, 1/12 each, because the shift of the
// lattice moves both counts alike. `of_edge` lies near the single edge; more edges in step with
// each other are part of the disorder below. Consecutive samples lie apart along the edge, so the
// variation of weights along it adds to that, up to the error of an edge of any direction.
//
// Irregular edges closer together than samples have the variance of independent samples. Pairs one
// and two steps apart then differ as often as random ones; regular edges make them differ more or
// less often.
float ordered_variance(const CoverageMask& mask, EdgesAlong edges, float variation, float n,
                       float spread) {
  constexpr float by_chance = 0.1f, of_edge = 0.15f;
  float order = 0, parted = 0;
  for (const uint32_t steps : {1u, 2u}) {
    const OrderedPairs pairs = ordered_pairs(mask, edges, steps);
    const float share = float(pairs.differing) / float(std::max(pairs.all, 1));
    if (steps == 1) parted = std::max(share * n, 1.0f);
    order = std::max(order, std::abs(share / (2 * spread) - 1));
  }
  const float disorder = std::clamp(1 + by_chance - order, 0.0f, 1.0f);
  const float of_random = random_variance(n, spread, 2 * n * spread);
  const float of_pair =
      of_edge + disorder * disorder * disorder * std::max(of_random - of_edge, 0.0f);
  return parted * of_pair + sqr(variation) * std::min(1.2f * parted, 0.4f * n * spread);
}

// Counts pairs of samples that are `rows` rows and some columns to the right or left apart: all
// pairs inside, and those that differ.
TROFFER_MULTIVERSION
void count_apart(const uint32_t* __restrict inside, const uint32_t* __restrict open, uint32_t rows,
                 uint32_t right, uint32_t left, int* __restrict counts) {
  int all = 0, differing = 0;
  for (uint32_t r = 0; r + rows < most_mask_rows; ++r) {
    const uint32_t in = inside[r] & (inside[r + rows] >> right << left);
    all += __builtin_popcount(in);
    differing += __builtin_popcount((open[r] ^ (open[r + rows] >> right << left)) & in);
  }
  counts[0] = all;
  counts[1] = differing;
}

}  // namespace

OrderedPairs ordered_pairs(const CoverageMask& mask, EdgesAlong edges, uint32_t steps) {
  // For both lattices a - 4 b = 1. Therefore (k + 1, j + 4) is the next sample in u, and (k - 4, j
  // + 1) the next in v.
  static_assert(fine_lattice.a - 4 * fine_lattice.b == 1);
  static_assert(coarse_lattice.a - 4 * coarse_lattice.b == 1);
  int counts[2];
  if (edges == EdgesAlong::v)
    count_apart(mask.inside.row, mask.open.row, 4 * steps, steps, 0, counts);
  else
    count_apart(mask.inside.row, mask.open.row, steps, 0, 4 * steps, counts);
  return {counts[0], counts[1]};
}

// Interpolates between the variance of an edge and that of independent samples. The fraction of
// neighbours that differ measures the disorder: it is least for a shape in one piece and largest
// for random samples.
float mask_variance(const MaskFrame& frame, const MaskWeight& sums, const CoverageMask& mask,
                    const MaskWeights& weights, EdgesAlong edges) {
  const auto rows = float(sums.row_pairs), columns = float(sums.column_pairs);
  const float pairs = rows + columns;
  if (pairs == 0) return 0;
  const auto n = float(sums.inside_count);
  const float share = float(sums.open_count) / n, spread = share * (1 - share);
  const float scale = sums.pair_squares / sqr(sums.all);
  if (edges != EdgesAlong::neither)
    return ordered_variance(mask, edges, variation_along(frame.lattice(), weights, edges), n,
                            spread) /
           pairs * scale;
  const float fewest = 4 * std::sqrt(n * std::min(share, 1 - share));  // for a square
  const float random = 2 * float(sums.neighbours) * spread;
  const float disorder = std::clamp((pairs - fewest) / std::max(random - fewest, 1.0f), 0.0f, 1.0f);
  const float of_edge = edge_variance(std::min(rows, columns), std::max(rows, columns));
  const float of_random = random_variance(n, spread, random);
  const float of_pair = of_edge + disorder * std::max(of_random - of_edge, 0.0f);
  return of_pair * scale;
}

}  // namespace troffer
