// Makes the tables of a report's page as HTML. report_page() puts them together.
#pragma once

#include <string>

#include "report/report.h"

namespace troffer {

// Builds a table from a head and rows; cells are HTML. style: CSS classes.
class HtmlTable {
 public:
  explicit HtmlTable(const std::vector<std::string>& head, const std::string& style = {});
  void add(const std::vector<std::string>& cells, const std::string& row_class = {});
  std::string html() const { return html_ + "</tbody></table></div>\n"; }

 private:
  std::string html_;
};

std::string figure_cell(const Figure& f);  // "412 ± 3"
const char* verdict_mark(Verdict v);       // coloured word for a verdict

// One row per surface: maintained mean, uniformity, glare, verdict. Requirements without a surface
// follow.
std::string summary_matrix(const Report& r);
// Lists the undecided requirements and the samples that would decide them; empty if there are none.
std::string undecided_list(const Report& r);
std::string figures_table(const SurfaceResult& s);
// Mean illuminance of each surface by each group of luminaires alone.
std::string contributions_table(const Assessment& a);
std::string glare_table(const Assessment& a);
std::string cylinder_table(const Assessment& a);
std::string luminaires_table(const Assessment& a, const Vec3d& up,
                             const std::vector<size_t>& types);
std::string daylight_table(const Assessment& a);
std::string power_table(const PowerResult& p);
std::string bias_table(const Assessment& a);
std::string info_tables(const ReportInfo& info);

}  // namespace troffer
