// Patterns and noise, and the ways from places in space to (u,v).
#pragma once

#include "scene/texture.h"

namespace troffer {

// Of the kinds from `checks` on.
TextureValue pattern_value(const std::vector<Texture>& textures, const Texture& t,
                           const TexturePlace& place);

// The place on t's own (u,v), where its mapping is of space or of the second set.
TexturePlace mapped_place(const Texture& t, const TexturePlace& place);

}  // namespace troffer
