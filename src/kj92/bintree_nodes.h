// Nodes of a bintree over a parametrised source: storage, cells, neighbours, and the values of
// inner nodes. bintree_rules.h holds the rules that grow and shrink a tree.
// Nodes of even level halve [0,1)² in u, those of odd level in v, so a cell of level L has the area
// 2^-L. A leaf holds one shadow ray. Cells are half open.
// References: [1] Kok & Jansen, "Adaptive Sampling of Area Light Sources in Ray Tracing Including
//   Diffuse Interreflection", Eurographics '92, §3.
//   [2] Cochran, "Sampling Techniques", 3rd ed. 1977, §5A.12 (collapsed strata).
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "base/random.h"
#include "base/vec.h"
#include "light/source_surface.h"
#include "shadow/flag.h"

namespace troffer {

// A node; inner nodes summarise their subtree.
struct BintreeNode {
  int32_t parent = -1;       // -1: the root
  int32_t first_child = -1;  // -1: a leaf; the second child follows the first
  uint16_t column = 0;       // column of the cell along u, in cells of this level
  uint16_t row = 0;          // along v
  uint8_t level = 0;
  ShadowFlag flag = ShadowFlag::shadow;
  bool is_visible = false;  // leaf: result of its ray
  float mean = 0;           // area-weighted mean of visibility × kernel over the cell
  float variance = 0;       // estimated variance of `mean`; 0 (unknown) for leaves
  uint32_t samples = 1;     // leaves of the subtree
  Vec2 uv;                  // leaf: end point of its ray
  float kernel = 1;         // leaf: value of its ray if visible

  bool is_leaf() const { return first_child < 0; }
};

enum class BintreeSide : uint8_t { left, right, below, above };  // -u, +u, -v, +v
constexpr std::array<BintreeSide, 4> bintree_sides{BintreeSide::left, BintreeSide::right,
                                                   BintreeSide::below, BintreeSide::above};

// Storage and geometry of the nodes. An index is valid until reset(), or until the parent is
// merged.
class BintreeNodes {
 public:
  // 4096 × 4096 cells. Deeper ones would leave too few bits of a float for the jitter.
  static constexpr int max_level = 24;
  static constexpr int32_t root = 0;

  // Makes room for `leaves` leaves. Larger trees allocate.
  explicit BintreeNodes(size_t leaves) {
    nodes_.reserve(2 * leaves);
    reset({0.5f, 0.5f});
  }
  // Resets to one leaf, the root, whose ray ends at uv.
  void reset(const Vec2& uv);

  const BintreeNode& operator[](int32_t i) const { return nodes_[size_t(i)]; }
  int32_t first_child(int32_t i) const { return (*this)[i].first_child; }
  int32_t sibling(int32_t i) const;  // i is not the root
  SourceCell cell(int32_t i) const;
  size_t capacity() const { return nodes_.capacity(); }

  // Halves a leaf above max_level. Its ray goes to the child that contains it. The other child gets
  // a jittered position without a result, and is returned.
  int32_t split(int32_t leaf, Random& jitter);
  // Turns a node with two leaves into a leaf, which keeps the ray of one of them by a coin toss.
  // The position is then uniform over the cell, as a jittered one is.
  void merge(int32_t node, Random& coin);
  // Draws a new position of a leaf's ray, uniform over its cell.
  void jitter(int32_t leaf, Random& random);
  // Stores the result of a leaf's ray; kernel as in ShadowRayResult.
  void set_result(int32_t leaf, bool is_visible, float kernel = 1);

  // [rule 2] Recomputes the ancestors of i, or i and its whole subtree.
  void propagate_up(int32_t i);
  void propagate_all(int32_t i = root);

  // Returns the node with cell (column, row) of `level`, or the larger leaf that contains that
  // cell.
  int32_t find(int level, uint32_t column, uint32_t row) const;
  // Returns the neighbour across a side of i's cell: the node of i's level, or the larger leaf
  // there. Returns -1 at the border of the square.
  int32_t neighbour(int32_t i, BintreeSide side) const;
  // Returns the deepest level of the leaves under i that touch the given side of i's cell.
  int deepest_along(int32_t i, BintreeSide side) const;

  // Calls visit(index) for every leaf under i, in tree order.
  template <class Visit>
  void for_each_leaf(Visit&& visit, int32_t i = root) const {
    if ((*this)[i].is_leaf()) return visit(i);
    for_each_leaf(visit, first_child(i));
    for_each_leaf(visit, first_child(i) + 1);
  }

 private:
  int32_t new_pair();
  void summarise(int32_t i);
  bool is_second_half(int32_t i, const Vec2& uv) const;

  std::vector<BintreeNode> nodes_;
  int32_t free_pair_ = -1;  // head of the free list, chained by first_child
};

}  // namespace troffer
