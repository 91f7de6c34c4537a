// Reads another report for `troffer report --compare`.
#pragma once

#include <string>

#include "report/comparison.h"

namespace troffer {

// Returns the figures of a report.json, and the plan and pictures in its folder if present. Throws
// InputError with line and column if the file is no report.
OtherReport read_other_report(const std::string& path);

}  // namespace troffer
