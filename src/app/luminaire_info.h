// Describes photometric files for `troffer info`.
#pragma once

#include <string>

namespace troffer {

// True if the file name ends in .ies or .ldt.
bool is_luminaire(const std::string& path);

// Returns flux, efficacy, beam and field angles, and the opening, as text or JSON. Writes the polar
// curves to the file `polar` (polar_curve.h) unless that is empty.
std::string luminaire_info(const std::string& path, bool is_json, const std::string& polar);

}  // namespace troffer
