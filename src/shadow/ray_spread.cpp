#include "shadow/ray_spread.h"

#include <algorithm>

#include "base/simd.h"
#include "base/units.h"

namespace troffer {

namespace {

// Sum of the squared differences of a[i] and b[i].
TROFFER_MULTIVERSION
float squared_differences(size_t n, const float* __restrict a, const float* __restrict b) {
  constexpr size_t lanes = 16;
  float sums[lanes] = {};
  const size_t whole = n / lanes * lanes;
  for (size_t i = 0; i < whole; i += lanes)
    for (size_t k = 0; k < lanes; ++k) {
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

double changes(std::span<const float> values) {
  return double(squared_differences(values.size() - 1, values.data(), values.data() + 1));
}

// Of the variance that strata tell, which keep the share `kept` of that of independent samples, so
// much is left by the sequence, which has strata of other shapes and sizes as well (measured:
// docs/certified.md). Strips gain nothing more before they fit nearly all that hides the source.
double left_by_squares(double kept) {
  return 0.3 + 0.7 * sqr(kept * kept * kept);
}
double left_by_strips(double kept) {
  return 0.3 + 0.7 * std::min(kept / 0.6, 1.0);
}

}  // namespace

void RaySpread::begin(uint32_t blocks, uint32_t of_block) {
  blocks_ = blocks;
  of_block_ = of_block;
  neighbours_.clear();
  random_ = 0;
}

// Of the rays in the order of one of their numbers, of which each block has one in each of so many
// equal parts.
double RaySpread::changes_along(std::span<const float> values, const float* numbers) {
  sorted_.resize(values.size());
  for (uint32_t b = 0, i = 0; b < blocks_; ++b)
    for (uint32_t k = 0; k < of_block_; ++k, ++i)
      sorted_[uint32_t(numbers[i] * float(of_block_)) * blocks_ + b] = values[i];
  return changes(sorted_);
}

void RaySpread::add(std::span<const float> values, std::span<const float> numbers) {
  const auto n = double(values.size());
  double sum = 0, squares = 0;
  for (const float v : values) {
    sum += double(v);
    squares += double(v) * double(v);
  }
  random_ += std::max(squares / n - sqr(sum / n), 0.0) / n;
  const double half = 1 / (2 * n * n);
  neighbours_.push_back({half * changes(values), half * changes_along(values, numbers.data()),
                         half * changes_along(values, numbers.data() + values.size())});
}

std::span<const double> RaySpread::variances() {
  variances_.clear();
  const auto receivers = double(neighbours_.size());
  const auto n = double(blocks_) * double(of_block_);
  // All together tell which strata fit, and how well: a receiver's own rays are few.
  size_t shape = 0;
  double factor = 1, least = 0;
  for (size_t k = 0; k < shapes; ++k) {
    double sum = 0;
    for (const std::array<double, shapes>& v : neighbours_) sum += v[k];
    const double kept = random_ > 0 ? std::min(sum / random_, 1.0) : 1;
    const double left = k == 0 ? left_by_squares(kept) : left_by_strips(kept);
    if (k > 0 && left * sum >= least) continue;
    least = left * sum;
    factor = left;
    shape = k;
  }
  // A receiver's own rays may all have met the same: the spread of all receivers' counts for one of
  // n + 1, and a ray of another answer for one of all.
  const double mean = least / receivers + 1 / sqr(n * receivers);
  for (const std::array<double, shapes>& v : neighbours_)
    variances_.push_back((n * factor * v[shape] + mean) / (n + 1));
  return variances_;
}

}  // namespace troffer
