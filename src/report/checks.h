// Requirements against what was measured.
#pragma once

#include <string>
#include <vector>

#include "report/assessment.h"

namespace troffer {

// All that the surfaces' profiles ask for, in the order of surfaces; then what `profile` asks of
// observers that belong to no surface, and above floors of cylindrical illuminance. Nothing where
// there is no light that counts.
std::vector<Check> checks_of(const Assessment& assessment, const std::vector<Profile>& profiles,
                             const std::string& profile);

// The worst of the observers of a surface (no_surface: of those that belong to none); null where
// none has a rating.
const Glare* worst_glare(const Assessment& assessment, size_t surface);

}  // namespace troffer
