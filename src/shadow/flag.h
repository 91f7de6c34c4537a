// Shadow flag of a source or source cell at a point.
#pragma once

#include <cstdint>

namespace troffer {

// light: all of it is visible; shadow: nothing; penumbra: some. At a bintree node the flag is a
// guess from the rays of its subtree. Certificates prove it.
enum class ShadowFlag : uint8_t { light, shadow, penumbra };

}  // namespace troffer
