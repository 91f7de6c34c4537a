// Readers of the single photometric formats; read_luminaire() in luminaire.h chooses one. Limits on
// counts and values reject invalid files before memory is allocated. Units are cd, lm and m.
#pragma once

#include <string>
#include <string_view>

#include "import/luminaire/luminaire.h"
#include "import/luminaire/luminaire_planes.h"

namespace troffer {

constexpr size_t max_intensities = size_t(4) << 20;
constexpr double most_candela = 1e12, most_lumens = 1e12, most_metres = 1e4;

// Reads LM-63. `folder` may hold a file of tilt factors; empty: none is read.
Luminaire read_ies(const std::string& path, std::string_view bytes, const std::string& folder,
                   WarningLog& warnings);
// Reads EULUMDAT.
Luminaire read_ldt(const std::string& path, std::string_view bytes, WarningLog& warnings);

// Sets negative intensities to 0, with a warning. Fails if all are dark.
void clean_intensities(Planes& planes, const PhotometricText& text, const std::string& path,
                       WarningLog& warnings);

}  // namespace troffer
