// JSON files that say what `report` assesses (docs/report.md).
#pragma once

#include <string>

#include "report/assessment.h"

namespace troffer {

// Adds a file's surfaces, observers and profiles (these in place of ones of the same id).
// InputError with line and column.
void read_report_file(const std::string& path, AssessmentOptions& options);

}  // namespace troffer
