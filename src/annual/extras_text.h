// Writes glare, sunlight and electric light (annual_extras.h) as CSV and as sections of the page;
// annual_text.cpp writes them as JSON.
#pragma once

#include <string>

#include "annual/annual_report.h"

namespace troffer {

// glare.csv: one row per hour with the sun up, with illuminance and DGP of each eye.
std::string glare_csv(const AnnualReport& report);
// electric.csv: one row per sensor, with the illuminance of each group and its standard error.
std::string electric_csv(const AnnualReport& report);
// Sections of annual.html; empty without extras.
std::string extras_sections(const AnnualReport& report);

}  // namespace troffer
