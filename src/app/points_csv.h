// The point lists of `troffer measure`.
#pragma once

#include <string>
#include <vector>

#include "render/measure.h"

namespace troffer {

// Header x,y,z,nx,ny,nz in any order, further columns kept aside; blank lines are skipped.
// InputError names line and column of what cannot be read (a zero normal, say).
std::vector<MeasuringPoint> read_points(const std::string& path);

}  // namespace troffer
