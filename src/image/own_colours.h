// Colour information of picture files (PNG gamma, ICC profiles), and its conversion to sRGB.
// Importers of textures call convert_to_srgb() after decode_raster().
// References: [1] ICC.1:2022, "Image technology colour management".
#pragma once

#include <cstdint>
#include <vector>

namespace troffer {

struct Raster;

struct OwnColours {
  // PNG's gAMA: stored values are light to this power (1/2.2 for sRGB, 1 for linear values); 0:
  // none.
  float gamma = 0;
  // ICC profile, which takes precedence over gamma; empty: none.
  std::vector<uint8_t> profile;

  bool is_empty() const { return gamma == 0 && profile.empty(); }
};

enum class ColoursFound {
  none,    // no information, or equal to sRGB: unchanged
  obeyed,  // converted
  broken,  // invalid profile or gamma, or other channels: ignored
};
// Warning text after a file's name.
constexpr const char* broken_colours = ": its colour profile cannot be used; read as sRGB";

// Converts the picture to sRGB, or keeps linear values and clears is_srgb. Alpha is unchanged.
// 8-bit pictures stay 8-bit, clipped to sRGB. ICC profiles use relative colorimetry [1].
ColoursFound convert_to_srgb(Raster& raster);

}  // namespace troffer
