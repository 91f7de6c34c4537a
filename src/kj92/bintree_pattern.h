// Reduces a bintree to an 8 × 8 lattice, by which image refinement compares neighbouring points.
// References: [1] Kok & Jansen, "Adaptive Sampling of Area Light Sources in Ray Tracing Including
//   Diffuse Interreflection", Eurographics '92, §5 (patterns of neighbouring rays are compared).
#pragma once

#include "kj92/bintree_nodes.h"
#include "transport/shadow_pattern.h"

namespace troffer {

// Returns the pattern of a tree. A leaf larger than a lattice cell sets all cells that it covers. A
// lattice cell with both visible and hidden leaves is neither lit nor dark.
ShadowPattern pattern_of(const BintreeNodes& nodes);

}  // namespace troffer
