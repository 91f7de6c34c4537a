// Requirements against what was measured.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "report/assessment.h"

namespace troffer {

// All that the surfaces' profiles ask for, in the order of surfaces, with the UGR limit of
// `profile` on floors and other surroundings of tasks; then what `profile` asks of observers that
// belong to no surface, and above floors of cylindrical illuminance. Nothing where there is no
// light that counts.
std::vector<Check> checks_of(const Assessment& assessment, const std::vector<Profile>& profiles,
                             const std::string& profile);

// How many samples per point would decide an open check, about, where `samples` were taken: errors
// fall with the root of the number. None where it is decided, or more than 1e9 are needed.
std::optional<double> samples_to_decide(const Check& check, double samples);

// The worst of the observers of a surface (no_surface: of those that belong to none); null where
// none has a rating.
const Glare* worst_glare(const Assessment& assessment, size_t surface);

}  // namespace troffer
