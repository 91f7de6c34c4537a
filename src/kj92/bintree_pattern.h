// Reduces a bintree to the 8 × 8 lattice in which neighbouring points are compared.
// References: [1] Kok & Jansen, "Adaptive Sampling of Area Light Sources in Ray Tracing Including
//   Diffuse Interreflection", Eurographics '92, §5 (patterns of neighbouring rays are compared).
#pragma once

#include "kj92/bintree_nodes.h"
#include "transport/shadow_pattern.h"

namespace troffer {

// A leaf larger than a lattice cell sets all cells that it covers; a cell with lit and dark leaves
// is neither lit nor dark.
ShadowPattern pattern_of(const BintreeNodes& nodes);

}  // namespace troffer
