// CIE 1931 2-degree observer, illuminant D65, and the conversion of XYZ to linear sRGB. Used by
// importers of spectra and by thin films. Wavelengths are in nm.
//
// References: [1] CIE 15:2004, "Colorimetry" (Table T.4: the observer; Table T.1: illuminant D65).
#pragma once

#include "base/rgb.h"
#include "base/vec.h"

namespace troffer {

constexpr int least_visible_nm = 360, most_visible_nm = 830;
constexpr int observer_step_nm = 5;  // between values of the tables; linear in between

// Colour matching functions [1]; 0 outside the visible range.
Vec3d color_matching(double nm);

// Spectral power of illuminant D65 [1], scaled to a mean of 1 over the observer's luminance curve.
double d65_power(double nm);

// XYZ -> linear sRGB (IEC 61966-2-1).
inline Rgb rgb_from_xyz(const Vec3d& c) {
  return {float(3.2404542 * c.x - 1.5371385 * c.y - 0.4985314 * c.z),
          float(-0.9692660 * c.x + 1.8760108 * c.y + 0.0415560 * c.z),
          float(0.0556434 * c.x - 0.2040259 * c.y + 1.0572252 * c.z)};
}

}  // namespace troffer
