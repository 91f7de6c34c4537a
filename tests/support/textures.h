// Images for tests.
#pragma once

#include "scene/texture.h"

namespace troffer::test {

// Returns a grey float image; value(x, y) gives its texels.
template <class Value>
Texture grey_image(int width, int height, const Value& value) {
  Texture t;
  t.kind = TextureKind::image;
  t.width = width;
  t.height = height;
  t.channels = 1;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) t.texels_float.push_back(value(x, y));
  return t;
}

}  // namespace troffer::test
