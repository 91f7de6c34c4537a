// Another report, read back, to set this one beside it: two variants of a design.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "report/statistics.h"

namespace troffer {

struct Report;

struct OtherCheck {
  std::string subject, quantity, verdict;  // as report.json has them
  double required = 0;
};

struct OtherSurface {
  std::string name;
  std::optional<Figure> mean, uniformity, ugr;  // lx; of electric light, or of daylight without it
};

struct OtherReport {
  std::string title;
  std::vector<OtherSurface> surfaces;
  std::vector<OtherCheck> checks;
  std::optional<double> lumens, watts, floor_area, watts_per_m2;  // lm, W, m²
  std::optional<Figure> task_mean, watts_per_100_lx;              // lx; W/m² per 100 lx
  // Files beside its report.json; empty where there is none.
  std::vector<uint8_t> plan, picture, luminance;  // SVG, PNG, PNG
};

// Both as tables with differences and verdicts, with plans and pictures beside each other, as HTML.
std::string comparison_section(const Report& report, const OtherReport& other);

}  // namespace troffer
