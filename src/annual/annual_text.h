// Writes the results of a year as JSON and CSV (docs/reference/annual.md).
#pragma once

#include <string>

#include "annual/annual_report.h"

namespace troffer {

// Returns annual.json: place, settings, and the figures and requirements of all grids, with errors.
std::string annual_json(const AnnualReport& report);

// Returns metrics.csv: one row per sensor, each figure followed by its standard error.
std::string annual_metrics(const AnnualReport& report);

}  // namespace troffer
