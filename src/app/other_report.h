// A report that was written before, read back for --compare.
#pragma once

#include <string>

#include "report/comparison.h"

namespace troffer {

// Figures of a report.json, and the plan and pictures beside it where there are any. InputError
// with line and column for files that are none.
OtherReport read_other_report(const std::string& path);

}  // namespace troffer
