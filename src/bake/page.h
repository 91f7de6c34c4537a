// A page of an atlas while it is filled.
#pragma once

#include <cstdint>
#include <vector>

#include "base/rgb.h"

namespace troffer {

// What a texel holds. Holes of cut-outs: alpha 0.
struct PageTexel {
  Rgb color{0};
  float alpha = 1, error = 0;
};

class Page {
 public:
  explicit Page(int size);

  // A texel that the chart of that number covers; known: false: its value is to come of others.
  void set(int x, int y, uint32_t chart, const PageTexel& texel, bool is_known);
  // Texels without value get the mean of neighbours that have one: those that a chart covers of its
  // own, however far; and up to `gutter` texels around charts, so that what blends neighbours finds
  // nothing else there.
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
