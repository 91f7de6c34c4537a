// Compares a report with another one that was read from its files: two variants of a design.
// app/other_report.h reads the other report; the report's page shows the comparison. Illuminance is
// in lx.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "report/statistics.h"

namespace troffer {

struct Report;

// A check of the other report.
struct OtherCheck {
  std::string subject, quantity, verdict;  // as in report.json
  double required = 0;
};

// A surface of the other report; figures that it lacks are empty.
struct OtherSurface {
  std::string name;
  std::optional<Figure> mean, uniformity, ugr;  // lx, ratio, UGR; electric light, or daylight
                                                // without it
};

// The other report; figures that it lacks are empty.
struct OtherReport {
  std::string title;
  std::vector<OtherSurface> surfaces;
  std::vector<OtherCheck> checks;
  std::optional<double> lumens, watts, floor_area, watts_per_m2;  // lm, W, m²
  std::optional<Figure> task_mean, watts_per_100_lx;              // lx; W/m² per 100 lx
  // Contents of the image files beside its report.json; empty if missing.
  std::vector<uint8_t> plan, picture, luminance;  // SVG, PNG, PNG
};

// Returns HTML with both reports' figures, differences and verdicts in tables, and with their plans
// and pictures side by side. A is the other report, B this one.
std::string comparison_section(const Report& report, const OtherReport& other);

}  // namespace troffer
