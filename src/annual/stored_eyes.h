// Reads the eyes of a folder that `troffer annual` wrote, with their glare in every hour. The files
// may come from anyone, so everything is checked. stored_hours.h keeps them for `troffer view`.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "render/measure.h"

namespace troffer {

// An eye in every hour with the sun up, with blinds as they were operated.
struct StoredEye {
  MeasuringPoint eye;  // its normal is the line of sight
  std::vector<float> dgp, vertical_lx;
};

// hours: middles of the hours with the sun up (StoredYear::hours). Returns nothing for a folder
// without eyes. Throws InputError if annual.json and glare.csv do not fit each other or the hours.
std::vector<StoredEye> read_stored_eyes(const std::string& folder, std::span<const double> hours);

}  // namespace troffer
