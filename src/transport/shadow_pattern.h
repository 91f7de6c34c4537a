// The visibility of a source from one point, on a lattice of 8 × 8 cells. Neighbouring points are
// compared by it; kj92/bintree_pattern.h makes it from a bintree.
// References: [1] Kok & Jansen, "Adaptive Sampling of Area Light Sources in Ray Tracing Including
//   Diffuse Interreflection", Eurographics '92, §5 (patterns of neighbouring rays are compared).
#pragma once

#include <bit>
#include <cstdint>

#include "light/source_surface.h"

namespace troffer {

// Bit 8 row + column, columns along u. A cell all of whose rays found light is lit, one all of
// whose rays found shadow is dark; one with both is neither.
struct ShadowPattern {
  static constexpr int side = 8;
  static constexpr int cells = side * side;

  uint64_t lit = 0, dark = 0;

  uint64_t mixed() const { return ~(lit | dark); }
  bool operator==(const ShadowPattern&) const = default;
};

// Cells in which the two do not say the same, or in which either says nothing definite.
inline uint64_t cells_in_doubt(const ShadowPattern& a, const ShadowPattern& b) {
  return ~((a.lit & b.lit) | (a.dark & b.dark));
}

// Share of the source that one saw and the other did not; a mixed cell counts half against a
// definite one.
inline float pattern_difference(const ShadowPattern& a, const ShadowPattern& b) {
  const uint64_t opposite = (a.lit & b.dark) | (a.dark & b.lit);
  const uint64_t half = a.mixed() ^ b.mixed();
  return (float(std::popcount(opposite)) + 0.5f * float(std::popcount(half))) /
         float(ShadowPattern::cells);
}

// Cell 0 … 63 in (u,v).
inline SourceCell pattern_cell(int cell) {
  const int column = cell % ShadowPattern::side, row = cell / ShadowPattern::side;
  constexpr float size = 1.0f / ShadowPattern::side;
  return {float(column) * size, float(column + 1) * size, float(row) * size, float(row + 1) * size};
}

}  // namespace troffer
