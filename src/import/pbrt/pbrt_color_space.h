// pbrt's colour spaces: what rgb triples of a file mean, in linear sRGB.
//
// References: [1] pbrt-v4 Input File Format, "Color spaces", pbrt.org/fileformat-v4.
//   [2] ITU-R BT.2020 and BT.709; SMPTE RP 431-2 (DCI-P3, with pbrt's white D65); SMPTE ST 2065-1.
#pragma once

#include <string>

#include "base/log.h"
#include "import/pbrt/pbrt_params.h"

namespace troffer {

enum class PbrtColorSpace { srgb, rec2020, dci_p3, aces2065_1 };

// Sets `space` by pbrt's name, in capitals too; an unknown one leaves it as it is, with a warning.
void read_pbrt_color_space(const std::string& name, const PbrtPlace& place, PbrtColorSpace& space,
                           WarningLog& warnings);

// Turns every rgb value into linear sRGB; values may come to lie outside [0,1]. What shines keeps
// its chromaticity; of all else the space's white is sRGB's, so that (1,1,1) stays a perfect white.
void to_srgb(PbrtParam& param, PbrtColorSpace space, bool shines);

}  // namespace troffer
