// Reader of the XML files in which LBNL WINDOW, genBSDF and others keep the directional scattering
// of glazing, blinds and fabrics. Used for Radiance's BSDF and aBSDF materials and for HBJSON.
//
// References: [1] LBNL, BSDF-v1.4 schema (windows.lbl.gov); [2] Radiance, src/common/bsdf_m.c
//   (orientation of the matrices).
#pragma once

#include <string>

#include "base/log.h"
#include "scene/angular_bsdf.h"

namespace troffer {

// Returns the visible matrices of a file: Klems bases, other bases that the file defines, and
// tensor trees, which are reduced to the full Klems basis with a warning. The file's front is the
// outside, which is the back of a surface [2]. If the transmission of one direction is missing or
// zero, it is the reverse of the other direction's. Throws InputError, with line and column in
// `text`, for malformed files and for matrices that scatter more light than arrives.
AngularBsdf read_window_xml(const std::string& file, const std::string& text, WarningLog& warnings);

}  // namespace troffer
