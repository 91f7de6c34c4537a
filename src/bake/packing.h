// Packs rectangles onto square pages. The atlas uses it; lengths are in texels.
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

// One page that fills from row 0 upward.
class Skyline {
 public:
  explicit Skyline(int size) : size_(size), parts_{{0, 0, size}} {}
  // Places a rectangle as low as possible, then as far left as possible. Returns false if there is
  // no room.
  bool add(const TexelSize& rectangle, TexelAt& at);

 private:
  struct Part {
    int x, y, width;
  };
  int size_;
  std::vector<Part> parts_;  // left to right

  // Returns the lowest row for a rectangle that starts at part i; -1 if it does not fit.
  int row_at(size_t i, const TexelSize& rectangle) const;
};

// Rectangles that must lie on one page.
struct PackGroup {
  std::vector<TexelSize> sizes;
  int page = -1;            // result
  std::vector<TexelAt> at;  // result, one per rectangle
};

// Places all groups and returns the number of pages of size × size. Returns 0 if a group needs more
// than a page, or if more than `most_pages` would be needed.
int pack(std::vector<PackGroup>& groups, int size, int most_pages);

}  // namespace troffer
