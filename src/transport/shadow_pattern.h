// Visibility of a source from one point, on a lattice of 8 × 8 cells. kj92 compares neighbouring
// points by it; kj92/bintree_pattern.h makes it from a bintree.
// References: [1] Kok & Jansen, "Adaptive Sampling of Area Light Sources in Ray Tracing Including
//   Diffuse Interreflection", Eurographics '92, §5 (patterns of neighbouring rays are compared).
#pragma once

#include <bit>
#include <cstdint>

#include "light/source_surface.h"

namespace troffer {

// Bit 8 row + column, with columns along u. A cell is lit if all its rays found light, dark if all
// found shadow, and mixed if it is neither.
struct ShadowPattern {
  static constexpr int side = 8;
  static constexpr int cells = side * side;

  uint64_t lit = 0, dark = 0;

  uint64_t mixed() const { return ~(lit | dark); }
  bool operator==(const ShadowPattern&) const = default;
};

// Returns the cells that are not lit in both or dark in both.
inline uint64_t cells_in_doubt(const ShadowPattern& a, const ShadowPattern& b) {
  return ~((a.lit & b.lit) | (a.dark & b.dark));
}

// Returns the share of the source on which the two disagree. A mixed cell counts as half a
// disagreement with a lit or dark one.
inline float pattern_difference(const ShadowPattern& a, const ShadowPattern& b) {
  const uint64_t opposite = (a.lit & b.dark) | (a.dark & b.lit);
  const uint64_t half = a.mixed() ^ b.mixed();
  return (float(std::popcount(opposite)) + 0.5f * float(std::popcount(half))) /
         float(ShadowPattern::cells);
}

// Returns the bounds in (u,v) of cell 0 … 63.
inline SourceCell pattern_cell(int cell) {
  const int column = cell % ShadowPattern::side, row = cell / ShadowPattern::side;
  constexpr float size = 1.0f / ShadowPattern::side;
  return {float(column) * size, float(column + 1) * size, float(row) * size, float(row + 1) * size};
}

}  // namespace troffer
