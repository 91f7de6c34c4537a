#include "kj92/bintree_nodes.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/units.h"

namespace troffer {

namespace {

// Returns how often a cell of this level has been halved in u and in v.
constexpr int u_bits(int level) {
  return (level + 1) / 2;
}
constexpr int v_bits(int level) {
  return level / 2;
}
constexpr bool splits_in_u(int level) {
  return level % 2 == 0;
}
// Returns 2^bits and its reciprocal. Scaling by them is exact.
constexpr float cells_along(int bits) {
  return float(1u << bits);
}
constexpr float size_of(int bits) {
  return 1 / cells_along(bits);
}
// Returns a position in [k, k+1) 2^-bits. Rounding must not reach the next cell.
float jittered(uint32_t k, int bits, float random) {
  const float size = size_of(bits);
  const float upper = float(k + 1) * size;
  return std::min((float(k) + random) * size, std::nextafter(upper, 0.0f));
}

}  // namespace

void BintreeNodes::reset(const Vec2& uv) {
  nodes_.clear();
  free_pair_ = -1;
  nodes_.emplace_back().uv = uv;
}

int32_t BintreeNodes::sibling(int32_t i) const {
  const int32_t first = first_child((*this)[i].parent);
  return i == first ? first + 1 : first;
}

SourceCell BintreeNodes::cell(int32_t i) const {
  const BintreeNode& n = (*this)[i];
  const float u = size_of(u_bits(n.level)), v = size_of(v_bits(n.level));
  return {float(n.column) * u, float(n.column + 1) * u, float(n.row) * v, float(n.row + 1) * v};
}

int32_t BintreeNodes::new_pair() {
  if (free_pair_ < 0) {
    nodes_.emplace_back();
    nodes_.emplace_back();
    return int32_t(nodes_.size()) - 2;
  }
  const int32_t pair = free_pair_;
  free_pair_ = first_child(pair);
  return pair;
}

bool BintreeNodes::is_second_half(int32_t i, const Vec2& uv) const {
  const BintreeNode& n = (*this)[i];
  if (splits_in_u(n.level)) return uv.x * cells_along(u_bits(n.level)) >= float(n.column) + 0.5f;
  return uv.y * cells_along(v_bits(n.level)) >= float(n.row) + 0.5f;
}

int32_t BintreeNodes::split(int32_t leaf, Random& random) {
  TROFFER_CHECK((*this)[leaf].is_leaf() && (*this)[leaf].level < max_level);
  const int32_t pair = new_pair();
  BintreeNode& parent = nodes_[size_t(leaf)];
  const bool in_u = splits_in_u(parent.level);
  for (int32_t half = 0; half < 2; ++half) {
    BintreeNode& child = nodes_[size_t(pair + half)];
    child = parent;
    child.parent = leaf;
    child.first_child = -1;
    child.level = uint8_t(parent.level + 1);
    if (in_u) child.column = uint16_t(2 * parent.column + half);
    if (!in_u) child.row = uint16_t(2 * parent.row + half);
  }
  const int32_t empty = is_second_half(leaf, parent.uv) ? pair : pair + 1;
  parent.first_child = pair;
  jitter(empty, random);
  return empty;
}

void BintreeNodes::merge(int32_t node, Random& coin) {
  BintreeNode& n = nodes_[size_t(node)];
  const int32_t pair = n.first_child;
  TROFFER_CHECK(pair >= 0 && (*this)[pair].is_leaf() && (*this)[pair + 1].is_leaf());
  const BintreeNode& kept = (*this)[pair + int32_t(coin.next_u32() >> 31)];
  n.uv = kept.uv;
  n.first_child = -1;
  set_result(node, kept.is_visible, kept.kernel);
  nodes_[size_t(pair)].first_child = free_pair_;
  free_pair_ = pair;
}

void BintreeNodes::jitter(int32_t leaf, Random& random) {
  BintreeNode& n = nodes_[size_t(leaf)];
  const Vec2 r = random.next_vec2();
  n.uv = {jittered(n.column, u_bits(n.level), r.x), jittered(n.row, v_bits(n.level), r.y)};
}

void BintreeNodes::set_result(int32_t leaf, bool is_visible, float kernel) {
  BintreeNode& n = nodes_[size_t(leaf)];
  n.is_visible = is_visible;
  n.kernel = kernel;
  n.flag = is_visible ? ShadowFlag::light : ShadowFlag::shadow;
  n.mean = is_visible ? kernel : 0;
  n.variance = 0;
  n.samples = 1;
}

// [rule 2] Computes the values of an inner node from its children. The paper leaves open how the
// variance of the mean is estimated. This is the area-weighted variance of all rays of the subtree,
// divided by their number less one, as if they were independent. It ignores stratification and thus
// overestimates, which is intended: sums over halves of estimated variances [2] vanish once flags
// are wrong, and stop far too early (docs/method/bintree.md).
void BintreeNodes::summarise(int32_t i) {
  BintreeNode& n = nodes_[size_t(i)];
  const BintreeNode &a = (*this)[n.first_child], &b = (*this)[n.first_child + 1];
  n.mean = 0.5f * (a.mean + b.mean);
  n.samples = a.samples + b.samples;
  n.flag = a.flag == b.flag ? a.flag : ShadowFlag::penumbra;
  const float spread_a = a.variance * float(a.samples - 1);
  const float spread_b = b.variance * float(b.samples - 1);
  const float spread = 0.5f * (spread_a + spread_b) + 0.25f * sqr(a.mean - b.mean);
  n.variance = spread / float(n.samples - 1);
}

void BintreeNodes::propagate_up(int32_t i) {
  for (int32_t p = (*this)[i].parent; p >= 0; p = (*this)[p].parent) summarise(p);
}

void BintreeNodes::propagate_all(int32_t i) {
  if ((*this)[i].is_leaf()) return;
  propagate_all(first_child(i));
  propagate_all(first_child(i) + 1);
  summarise(i);
}

int32_t BintreeNodes::find(int level, uint32_t column, uint32_t row) const {
  int32_t i = root;
  for (int l = 0; l < level && !(*this)[i].is_leaf(); ++l) {
    const uint32_t half = splits_in_u(l) ? column >> (u_bits(level) - u_bits(l) - 1)
                                         : row >> (v_bits(level) - v_bits(l) - 1);
    i = first_child(i) + int32_t(half & 1);
  }
  return i;
}

int32_t BintreeNodes::neighbour(int32_t i, BintreeSide side) const {
  const BintreeNode& n = (*this)[i];
  // unsigned: -1 wraps to the largest number, which lies outside too
  const uint32_t column = uint32_t(n.column) + uint32_t(side == BintreeSide::right) -
                          uint32_t(side == BintreeSide::left);
  const uint32_t row =
      uint32_t(n.row) + uint32_t(side == BintreeSide::above) - uint32_t(side == BintreeSide::below);
  if (column >> u_bits(n.level) != 0 || row >> v_bits(n.level) != 0) return -1;
  return find(n.level, column, row);
}

int BintreeNodes::deepest_along(int32_t i, BintreeSide side) const {
  const BintreeNode& n = (*this)[i];
  if (n.is_leaf()) return n.level;
  const int32_t a = n.first_child, b = a + 1;
  if (splits_in_u(n.level)) {
    if (side == BintreeSide::left) return deepest_along(a, side);
    if (side == BintreeSide::right) return deepest_along(b, side);
  } else {
    if (side == BintreeSide::below) return deepest_along(a, side);
    if (side == BintreeSide::above) return deepest_along(b, side);
  }
  return std::max(deepest_along(a, side), deepest_along(b, side));
}

}  // namespace troffer
