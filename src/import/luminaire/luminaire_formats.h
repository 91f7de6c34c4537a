// One reader for each format of photometric files; luminaire.h picks one.
#pragma once

#include <string>
#include <string_view>

#include "import/luminaire/luminaire.h"
#include "import/luminaire/luminaire_planes.h"

namespace troffer {

constexpr size_t max_intensities = size_t(4) << 20;
constexpr double most_candela = 1e12, most_lumens = 1e12, most_metres = 1e4;

// LM-63. `folder`: where a file of tilt factors may lie; empty: nowhere.
Luminaire read_ies(const std::string& path, std::string_view bytes, const std::string& folder,
                   WarningLog& warnings);
Luminaire read_ldt(const std::string& path, std::string_view bytes, WarningLog& warnings);

// Intensities below 0 become 0, with a warning; fails where all are dark.
void clean_intensities(Planes& planes, const PhotometricText& text, const std::string& path,
                       WarningLog& warnings);

}  // namespace troffer
