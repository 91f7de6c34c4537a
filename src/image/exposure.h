// Automatic exposure for showing a picture on a display. Picture previews, baking and reports use
// it. Exposures are in stops: powers of two of linear light.
#pragma once

#include "image/image.h"

namespace troffer {

// Brightness of a picture without exposure.
struct Brightness {
  bool is_black = true;   // no pixel has light
  double auto_stops = 0;  // brings the mean log luminance to mid-grey
};

// Uses pixels that are finite and not black, without the darkest and the brightest twentieth.
Brightness brightness(const Image& image);

}  // namespace troffer
