// Compares the measured light of a scene with the requirements of its profiles.
// assess() fills Assessment::checks with it; report pages name the worst observer and the samples
// that would decide an open check.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "report/assessment.h"

namespace troffer {

// Returns all checks: what the profiles of the surfaces require, in the order of surfaces, then
// what `profile` requires of observers without a surface and of cylindrical illuminance above
// floors. Floors and other surroundings of tasks get the UGR limit of `profile`. Quantities without
// light yield no check.
std::vector<Check> checks_of(const Assessment& assessment, const std::vector<Profile>& profiles,
                             const std::string& profile);

// Returns about how many samples per point would decide an open check that was made with `samples`;
// errors fall with the root of the number. Empty if the check is decided, or if more than 1e9 are
// needed.
std::optional<double> samples_to_decide(const Check& check, double samples);

// Returns the highest UGR among the observers of a surface (no_surface: those that belong to none).
// Null if none has a rating.
const Glare* worst_glare(const Assessment& assessment, size_t surface);

}  // namespace troffer
