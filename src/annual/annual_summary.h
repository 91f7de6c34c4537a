// First section of the annual page: all grids with their levels, and whether the settings are those
// that LEED asks for. Also small pieces of text for the other sections.
//
// References: [1] USGBC, "LEED v4.1 Building Design and Construction", EQ credit Daylight.
//   [2] IES LM-83-12, "Spatial daylight autonomy and annual sunlight exposure".
#pragma once

#include <string>

#include "annual/annual_report.h"

namespace troffer {

std::string summary_section(const AnnualReport& report);

// "8.33 ± 0.41 %" as HTML; without an error if all replicates agree.
std::string year_figure_text(const YearFigure& figure, const std::string& unit);
std::string year_verdict_mark(YearVerdict verdict);

// Largest distance from a sensor of a grid to the nearest other one, in metres. 0 for a single
// sensor.
double grid_spacing(const AnnualReport& report, const AnnualGrid& grid);

}  // namespace troffer
