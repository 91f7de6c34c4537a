// How bright a picture should be shown.
#pragma once

#include "image/image.h"

namespace troffer {

// What a picture is when shown without exposure.
struct Brightness {
  bool is_black = true;   // no pixel has light
  double auto_stops = 0;  // by which the mean of the logarithm of its luminance comes to mid-grey
};

// Of the pixels that are finite and have light; the darkest and the brightest twentieth of them do
// not count.
Brightness brightness(const Image& image);

}  // namespace troffer
