// Contents of a report, and its outputs: an HTML page, JSON, a table of points, and plans.
// The `report` command fills in a Report and writes these files. Illuminance is in lx, lengths in
// m.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "report/assessment.h"
#include "report/comparison.h"
#include "report/pictures.h"

namespace troffer {

// A file that the report's figures depend on.
struct InputHash {
  std::string file;  // as named
  uint64_t bytes = 0;
  std::string sha256;
};

// Program, inputs and settings of a report. Names may contain any bytes.
struct ReportInfo {
  std::string title;
  std::string date;  // as given; empty: none
  std::string scene;
  std::string version, command;
  std::vector<std::pair<std::string, std::string>> settings;
  std::vector<InputHash> inputs;
  std::vector<std::string> warnings;
};

// All data of a report.
struct Report {
  ReportInfo info;
  AssessmentOptions options;
  Assessment assessment;
  std::vector<ReportPicture> pictures;
  std::optional<OtherReport> other;  // a variant to compare with
};

// Returns a plan of each storey, as SVG.
std::vector<std::string> report_plans(const Report& report);

// Returns one self-contained HTML page for screens and paper (A4).
std::string report_page(const Report& report);
// Returns the same as JSON (docs/reference/report.md), without pictures.
std::string report_json(const Report& report);
// Returns all points as CSV: surface,column,row,x,y,z,nx,ny,nz,electric_lx,electric_error,
// daylight_lx,daylight_error,daylight_factor_percent,daylight_factor_error. Fields that were not
// measured are empty.
std::string report_points(const Report& report);

}  // namespace troffer
