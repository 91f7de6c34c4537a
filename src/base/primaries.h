// Colours of other primaries than those of linear sRGB.
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
  Chromaticity white;                  // what (1, 1, 1) is
};

constexpr Primaries srgb_primaries{{{{0.64, 0.33}, {0.30, 0.60}, {0.15, 0.06}}}, {0.3127, 0.3290}};

// Linear sRGB of a colour of those primaries [1]. `keeps_white`: (1, 1, 1) becomes (1, 1, 1), seen
// under its own white as the other is under D65 [2]; else colours stay the lights that they are.
// Not finite where the primaries span no colours.
Affine srgb_from(const Primaries& primaries, bool keeps_white);

// Whether they are those of sRGB, to the digits that files have.
bool are_srgb(const Primaries& primaries);

}  // namespace troffer
