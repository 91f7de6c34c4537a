// Estimates the variance of direct rays (direct_rays.h) from the rays themselves.
// An Owen-scrambled Sobol sequence is stratified in several shapes at once: squares, and strips
// along either dimension. Neighbouring strata of a shape differ by what the strata leave to chance,
// so each shape gives an upper estimate of the variance. The least of them is used.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace troffer {

// Collects the rays of some receivers, then returns their variances. Not thread safe.
class RaySpread {
 public:
  // Starts receivers with blocks × of_block rays each; of_block is a power of two.
  void begin(uint32_t blocks, uint32_t of_block);
  // Adds the next receiver. values: contributions of its rays relative to its unoccluded light,
  // block by block, in the order of the sequence. numbers: the random numbers of the rays, first
  // all of one dimension.
  void add(std::span<const float> values, std::span<const float> numbers);
  // Returns the variance of the mean of each receiver's values, in the order of add().
  std::span<const double> variances();

 private:
  void sort_along(std::span<const float> values, const float* numbers);

  static constexpr size_t steps_apart = 4;
  static constexpr size_t shapes = 3;  // squares, strips one way, strips the other way
  uint32_t blocks_ = 1, of_block_ = 1;
  std::vector<float> sorted_;  // values in the order of one dimension
  std::vector<std::array<double, shapes>> neighbours_;
  std::array<double, shapes> apart_{};  // for samples steps_apart apart
  std::vector<double> variances_;
};

}  // namespace troffer
