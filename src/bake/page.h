// One page of an atlas while it is filled. bake() sets texels and fills the gaps.
#pragma once

#include <cstdint>
#include <vector>

#include "base/rgb.h"

namespace troffer {

// Value of a texel. Cut-outs have alpha 0.
struct PageTexel {
  Rgb color{0};
  float alpha = 1, error = 0;
};

// A square page of texels.
class Page {
 public:
  explicit Page(int size);

  // Sets a texel that a chart covers. is_known = false: fill() takes its value from neighbours.
  void set(int x, int y, uint32_t chart, const PageTexel& texel, bool is_known);
  // Gives texels without a value the mean of their neighbours: all texels that a chart covers, and
  // up to `gutter` texels around charts, so that filtering across the border finds the same value.
  void fill(int gutter);

  int size() const { return size_; }
  const PageTexel& at(int x, int y) const { return texels_[index(x, y)]; }
  bool is_known(int x, int y) const { return is_known_[index(x, y)] != 0; }
  uint32_t chart(int x, int y) const { return chart_[index(x, y)]; }
  static constexpr uint32_t no_chart = 0xffffffffu;

 private:
  int size_;
  std::vector<PageTexel> texels_;
  std::vector<uint32_t> chart_;
  std::vector<uint8_t> is_known_;

  size_t index(int x, int y) const { return size_t(y) * size_t(size_) + size_t(x); }
  bool mean_of_neighbours(size_t texel, PageTexel& out, uint32_t& chart) const;
  std::vector<size_t> around(const std::vector<size_t>& texels) const;
  void fill_round(std::vector<size_t>& open);
};

}  // namespace troffer
