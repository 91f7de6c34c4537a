#include "shadow/ray_spread.h"

#include <algorithm>

#include "base/simd.h"
#include "base/units.h"
#include "shadow/vector_lanes.h"

namespace troffer {

namespace {

// Returns the sum of squared differences of a[i] and b[i].
TROFFER_MULTIVERSION
float squared_differences(size_t n, const float* __restrict a, const float* __restrict b) {
  float sums[vector_lanes] = {};
  const size_t whole = n / vector_lanes * vector_lanes;
  for (size_t i = 0; i < whole; i += vector_lanes)
    for (size_t k = 0; k < vector_lanes; ++k) {
      const float d = a[i + k] - b[i + k];
      sums[k] += d * d;
    }
  for (size_t i = whole; i < n; ++i) {
    const float d = a[i] - b[i];
    sums[i - whole] += d * d;
  }
  float sum = 0;
  for (const float s : sums) sum += s;
  return sum;
}

// Returns the squared differences of values `steps` apart, scaled to the number of neighbouring
// pairs.
double changes(std::span<const float> values, size_t steps) {
  if (values.size() <= steps) return 0;
  const size_t n = values.size() - steps;
  const double sum = double(squared_differences(n, values.data(), values.data() + steps));
  return sum * double(values.size() - 1) / double(n);
}

// Share of a shape's variance that the sequence leaves, since it has strata of other shapes and
// sizes too. kept: squared difference of neighbours over that of samples a few strata apart
// (measured: docs/log/certified-visibility.md, "Residual rays").
double left_by_squares(double kept) {
  const double fine = std::clamp((kept - 0.6) / 0.38, 0.0, 1.0);
  return 0.3 + 0.7 * fine * fine * fine;
}
double left_by_strips(double kept) {
  return 0.3 + 0.7 * sqr(kept);
}

}  // namespace

void RaySpread::begin(uint32_t blocks, uint32_t of_block) {
  blocks_ = blocks;
  of_block_ = of_block;
  neighbours_.clear();
  apart_ = {};
}

// Sorts the rays by one of their random numbers, of which each block has one in each of of_block
// equal strata.
void RaySpread::sort_along(std::span<const float> values, const float* numbers) {
  sorted_.resize(values.size());
  for (uint32_t b = 0, i = 0; b < blocks_; ++b)
    for (uint32_t k = 0; k < of_block_; ++k, ++i)
      sorted_[uint32_t(numbers[i] * float(of_block_)) * blocks_ + b] = values[i];
}

void RaySpread::add(std::span<const float> values, std::span<const float> numbers) {
  const auto n = double(values.size());
  const double half = 1 / (2 * n * n);
  std::array<double, shapes>& own = neighbours_.emplace_back();
  for (size_t k = 0; k < shapes; ++k) {
    if (k > 0) sort_along(values, numbers.data() + (k - 1) * values.size());
    const std::span<const float> ordered = k == 0 ? values : std::span<const float>(sorted_);
    own[k] = half * changes(ordered, 1);
    apart_[k] += half * changes(ordered, steps_apart);
  }
}

std::span<const double> RaySpread::variances() {
  variances_.clear();
  const auto receivers = double(neighbours_.size());
  const auto n = double(blocks_) * double(of_block_);
  // The rays of all receivers decide which shape fits and how well, because one receiver has few.
  size_t shape = 0;
  double factor = 1, least = 0;
  for (size_t k = 0; k < shapes; ++k) {
    double sum = 0;
    for (const std::array<double, shapes>& v : neighbours_) sum += v[k];
    const double kept = apart_[k] > 0 ? std::min(sum / apart_[k], 1.0) : 1;
    const double left = k == 0 ? left_by_squares(kept) : left_by_strips(kept);
    if (k > 0 && left * sum >= least) continue;
    least = left * sum;
    factor = left;
    shape = k;
  }
  // All rays of a receiver may have met the same. Its variance is therefore mixed with the mean of
  // all receivers, with weight 1 of n + 1. The mean includes the effect of one ray with another
  // answer.
  const double mean = least / receivers + 1 / sqr(n * receivers);
  for (const std::array<double, shapes>& v : neighbours_)
    variances_.push_back((n * factor * v[shape] + mean) / (n + 1));
  return variances_;
}

}  // namespace troffer
