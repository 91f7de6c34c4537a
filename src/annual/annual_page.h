// The page of `troffer annual`: one HTML file for screens and paper, without scripts.
#pragma once

#include <string>

#include "annual/annual_report.h"

namespace troffer {

std::string annual_page(const AnnualReport& report);

}  // namespace troffer
