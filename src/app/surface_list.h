// Lists of surfaces that `report` assesses, as tables.
#pragma once

#include <string>

#include "report/assessment.h"

namespace troffer {

// Adds one surface for each row: `node`, or a rectangle by its corner x,y,z and its sides ax,ay,az
// and bx,by,bz, m; and, where wanted, name, profile, lift and border (SurfaceRequest). A note names
// columns that are not used. InputError with line and column.
void read_surface_list(const std::string& path, AssessmentOptions& options);

}  // namespace troffer
