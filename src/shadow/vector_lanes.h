// Number of values that vectorised loops of this room work on together.
#pragma once

#include <cstddef>

namespace troffer {

// Floats in the widest vector register, of AVX-512. Sums are kept per lane, so results are the same
// bits with narrower registers.
constexpr size_t vector_lanes = 16;

}  // namespace troffer
