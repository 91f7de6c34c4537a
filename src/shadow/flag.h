// What is known of how much of a source, or of a cell of it, a point sees.
#pragma once

#include <cstdint>

namespace troffer {

enum class ShadowFlag : uint8_t { light, shadow, penumbra };

}  // namespace troffer
