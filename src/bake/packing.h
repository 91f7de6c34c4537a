// Rectangles on pages.
//
// References: [1] Jylänki, "A Thousand Ways to Pack the Bin", 2010, §2.5 (skyline, bottom left).
#pragma once

#include <cstddef>
#include <vector>

namespace troffer {

struct TexelSize {
  int width = 0, height = 0;
};
struct TexelAt {
  int x = 0, y = 0;
};

// One page that fills from row 0 up.
class Skyline {
 public:
  explicit Skyline(int size) : size_(size), parts_{{0, 0, size}} {}
  // Where a rectangle comes to lie as low as it can, then as far left; false where there is no
  // room.
  bool add(const TexelSize& rectangle, TexelAt& at);

 private:
  struct Part {
    int x, y, width;
  };
  int size_;
  std::vector<Part> parts_;  // left to right

  // The lowest row on which a rectangle can stand from part i on; -1: none.
  int row_at(size_t i, const TexelSize& rectangle) const;
};

// Rectangles that are to come on one page together.
struct PackGroup {
  std::vector<TexelSize> sizes;
  int page = -1;            // found
  std::vector<TexelAt> at;  // found, one each
};

// Finds places for all groups: number of pages of size × size. 0: a group needs more than a page,
// or more than `most_pages` would be needed.
int pack(std::vector<PackGroup>& groups, int size, int most_pages);

}  // namespace troffer
