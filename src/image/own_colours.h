// What picture files say of their colours, and pictures made of it that are in sRGB.
#pragma once

#include <cstdint>
#include <vector>

namespace troffer {

struct Raster;

struct OwnColours {
  // PNG's gAMA: values are light to this power (1/2.2 of sRGB, 1 of linear ones); 0: nothing is
  // said.
  float gamma = 0;
  // An ICC profile, which goes before gamma; empty: none.
  std::vector<uint8_t> profile;

  bool is_empty() const { return gamma == 0 && profile.empty(); }
};

enum class ColoursFound {
  none,    // nothing is said, or what sRGB would be: the picture stays as it is
  obeyed,  // converted
  broken,  // a profile that cannot be read, or of other channels than the picture's, or a gamma
           // that is no picture's: left out
};
// After a file's name, where they are.
constexpr const char* broken_colours =
    ": what it says of its colours cannot be used; taken for sRGB";

// To sRGB, or to linear values where the file's are: is_srgb says so. Alpha stays. 8-bit pictures
// stay 8-bit, and what lies outside of sRGB is cut off. Profiles: by relative colorimetry [1].
//
// 1. ICC.1:2022, Image technology colour management.
ColoursFound obey_own_colours(Raster& raster);

}  // namespace troffer
