// Conversion of colours with other primaries to linear sRGB. Used by importers, for files with
// their own colour space. Chromaticities are CIE 1931 x, y.
//
// References: [1] SMPTE RP 177:1993 (matrices from chromaticities); [2] Lam's matrix of cones as
//   ICC.1:2010, Annex E, has it ("Bradford").
#pragma once

#include <array>

#include "base/transform.h"

namespace troffer {

struct Chromaticity {
  double x = 0, y = 0;
};
struct Primaries {
  std::array<Chromaticity, 3> colors;  // red, green, blue
  Chromaticity white;                  // chromaticity of (1, 1, 1)
};

constexpr Primaries srgb_primaries{{{{0.64, 0.33}, {0.30, 0.60}, {0.15, 0.06}}}, {0.3127, 0.3290}};

// Matrix from colours of these primaries to linear sRGB [1]. With keeps_white, (1, 1, 1) stays (1,
// 1, 1) by chromatic adaptation to D65 [2]; otherwise colours keep their chromaticity. Not finite
// if the primaries are degenerate.
Affine srgb_from(const Primaries& primaries, bool keeps_white);

// True if they are sRGB's, to the precision of files.
bool are_srgb(const Primaries& primaries);

}  // namespace troffer
