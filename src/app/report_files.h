// Reads files that specify what `report` assesses (docs/reference/report.md): JSON, or tables of
// surfaces.
#pragma once

#include <string>

#include "report/assessment.h"

namespace troffer {

// Adds a file's surfaces, observers and profiles; a profile replaces one with the same id. A .csv
// is a list of surfaces (app/surface_list.h). Throws InputError with line and column.
void read_report_file(const std::string& path, AssessmentOptions& options);

}  // namespace troffer
