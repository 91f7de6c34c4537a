#include "kj92/bintree_pattern.h"

#include <algorithm>
#include <cmath>

namespace troffer {

namespace {

// Returns the lattice cells that a source cell covers or lies in.
uint64_t cells_of(const SourceCell& c) {
  constexpr int side = ShadowPattern::side;
  const auto first = [](float x) {
    return std::clamp(int(x * float(ShadowPattern::side)), 0, ShadowPattern::side - 1);
  };
  const auto last = [](float x) {
    return std::clamp(int(std::ceil(x * float(ShadowPattern::side))), 1, ShadowPattern::side);
  };
  const int u0 = first(c.u0), v0 = first(c.v0);
  const int u1 = std::max(last(c.u1), u0 + 1), v1 = std::max(last(c.v1), v0 + 1);
  const uint64_t row = ((uint64_t(1) << (u1 - u0)) - 1) << u0;
  uint64_t cells = 0;
  for (int v = v0; v < v1; ++v) cells |= row << (side * v);
  return cells;
}

}  // namespace

ShadowPattern pattern_of(const BintreeNodes& nodes) {
  uint64_t light = 0, shadow = 0;
  nodes.for_each_leaf([&](int32_t leaf) {
    (nodes[leaf].is_visible ? light : shadow) |= cells_of(nodes.cell(leaf));
  });
  return {light & ~shadow, shadow & ~light};
}

}  // namespace troffer
