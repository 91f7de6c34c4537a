// Procedural patterns and noise, and mappings from positions in space to (u,v). Used by evaluate()
// in scene/texture.cpp.
#pragma once

#include "scene/texture.h"

namespace troffer {

// Value of a texture whose kind is `checks` or a later one.
TextureValue pattern_value(const std::vector<Texture>& textures, const Texture& t,
                           const TexturePlace& place);

// Place in t's own (u,v), for mappings from space or from the second (u,v).
TexturePlace mapped_place(const Texture& t, const TexturePlace& place);

}  // namespace troffer
