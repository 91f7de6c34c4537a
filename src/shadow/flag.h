// What is known of how much of a source, or of a cell of it, a point sees.
#pragma once

#include <cstdint>

namespace troffer {

// light: all of it; shadow: nothing; penumbra: some. Of a bintree's node it is what the rays of its
// subtree say, and therefore a guess; certificates prove it.
enum class ShadowFlag : uint8_t { light, shadow, penumbra };

}  // namespace troffer
