// What info tells of photometric files.
#pragma once

#include <string>

namespace troffer {

// By the ending of a file: .ies or .ldt.
bool is_luminaire(const std::string& path);

// Lumens, efficacy, beam and field angles, the opening: as text, or as JSON. Draws the polar curves
// to the file `polar` (polar_curve.h) where it has a name.
std::string luminaire_info(const std::string& path, bool is_json, const std::string& polar);

}  // namespace troffer
