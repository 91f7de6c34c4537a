// Images at half their width and height.
#pragma once

#include "scene/texture.h"

namespace troffer {

// The same image, each texel the mean, in linear light, of two by two (fewer at the ends of odd
// sizes). One of a single texel stays as it is.
Texture halved(Texture image);

}  // namespace troffer
