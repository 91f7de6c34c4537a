// Colour spaces of pbrt files: converts their rgb triples to linear sRGB. Used by PbrtInterpreter
// for every parameter list.
//
// References: [1] pbrt-v4 Input File Format, "Color spaces", pbrt.org/fileformat-v4.
//   [2] ITU-R BT.2020 and BT.709; SMPTE RP 431-2 (DCI-P3, with pbrt's white D65); SMPTE ST 2065-1.
#pragma once

#include <string>

#include "base/log.h"
#include "import/pbrt/pbrt_params.h"

namespace troffer {

enum class PbrtColorSpace { srgb, rec2020, dci_p3, aces2065_1 };

// Sets `space` to the one that pbrt calls `name`, in any case. An unknown name adds a warning and
// leaves `space` unchanged.
void read_pbrt_color_space(const std::string& name, const PbrtPlace& place, PbrtColorSpace& space,
                           WarningLog& warnings);

// Converts an rgb parameter to linear sRGB; values may leave [0,1]. Emission (`shines`) keeps its
// chromaticity. All other colours are adapted to sRGB's white, so that (1,1,1) stays a perfect
// white.
void to_srgb(PbrtParam& param, PbrtColorSpace space, bool shines);

}  // namespace troffer
