// Reads tables of surfaces that `report` assesses.
#pragma once

#include <string>

#include "report/assessment.h"

namespace troffer {

// Adds one surface per row: a `node`, or a rectangle by its corner x,y,z and its sides ax,ay,az and
// bx,by,bz in metres. Optional columns are name, profile, lift and border (SurfaceRequest). A note
// names unused columns. Throws InputError with line and column.
void read_surface_list(const std::string& path, AssessmentOptions& options);

}  // namespace troffer
