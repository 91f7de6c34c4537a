// Images reduced to half their width and height. TextureLoader uses it to stay within its memory
// limit.
#pragma once

#include "scene/texture.h"

namespace troffer {

// Returns the image with each texel the mean, in linear light, of two by two (fewer at the ends of
// odd sizes). A single texel stays as it is.
Texture halved(Texture image);

}  // namespace troffer
