// A report: what was assessed, by what, as a page, as JSON and as a table.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "report/assessment.h"
#include "report/comparison.h"
#include "report/pictures.h"

namespace troffer {

// A file that the figures rest on.
struct InputHash {
  std::string file;  // as named
  uint64_t bytes = 0;
  std::string sha256;
};

// How the report was made; names may hold anything.
struct ReportInfo {
  std::string title;
  std::string date;  // as given; empty: none
  std::string scene;
  std::string version, command;
  std::vector<std::pair<std::string, std::string>> settings;
  std::vector<InputHash> inputs;
  std::vector<std::string> warnings;
};

struct Report {
  ReportInfo info;
  AssessmentOptions options;
  Assessment assessment;
  std::vector<ReportPicture> pictures;
  std::optional<OtherReport> other;  // a variant to be compared with
};

// A plan of each storey, as SVG.
std::vector<std::string> report_plans(const Report& report);

// One HTML page without anything from elsewhere, for screens and paper (A4).
std::string report_page(const Report& report);
// The same as JSON (docs/report.md), without pictures.
std::string report_json(const Report& report);
// All points: surface,column,row,x,y,z,nx,ny,nz,electric_lx,electric_error,daylight_lx,
// daylight_error,daylight_factor_percent,daylight_factor_error; what was not measured is empty.
std::string report_points(const Report& report);

}  // namespace troffer
