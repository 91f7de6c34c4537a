// What rays straight to a source err by, as they tell themselves.
//
// Points of an Owen-scrambled Sobol sequence are strata of many shapes at once: n of them lie one
// each in squares, and in strips along either number. What two neighbours differ by is what their
// strata leave to chance, so that each shape tells a variance of its own, and the sequence errs by
// no more than the least of them.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace troffer {

class RaySpread {
 public:
  // Of receivers with blocks × of_block rays each; of_block: a power of two.
  void begin(uint32_t blocks, uint32_t of_block);
  // What the rays of the next receiver bring, relative to its unoccluded light, block by block,
  // those side by side that lie together; numbers: those that their points were made from, first
  // all of one dimension.
  void add(std::span<const float> values, std::span<const float> numbers);
  // The variance of the mean of each receiver's values, in the order of add().
  std::span<const double> variances();

 private:
  void sort_along(std::span<const float> values, const float* numbers);

  static constexpr size_t steps_apart = 4;
  static constexpr size_t shapes = 3;  // squares, strips one way, strips the other way
  uint32_t blocks_ = 1, of_block_ = 1;
  std::vector<float> sorted_;  // values in another order
  std::vector<std::array<double, shapes>> neighbours_;
  std::array<double, shapes> apart_{};  // sum over receivers: the same of samples steps_apart apart
  std::vector<double> variances_;
};

}  // namespace troffer
