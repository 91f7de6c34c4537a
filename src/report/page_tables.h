// The tables of a report's page, as HTML.
#pragma once

#include <string>

#include "report/report.h"

namespace troffer {

// A table: a head and rows of cells that are HTML already.
class HtmlTable {
 public:
  explicit HtmlTable(const std::vector<std::string>& head);
  void add(const std::vector<std::string>& cells, const std::string& row_class = {});
  std::string html() const { return html_ + "</tbody></table></div>\n"; }

 private:
  std::string html_;
};

std::string figure_cell(const Figure& f);  // "412 ± 3"
std::string checks_table(const Assessment& a, const std::vector<Profile>& profiles);
std::string summary_table(const SurfaceResult& s);
std::string contributions_table(const Assessment& a, const SurfaceResult& s);
std::string glare_table(const Assessment& a);
std::string cylinder_table(const Assessment& a);
std::string luminaires_table(const Assessment& a);
std::string power_table(const PowerResult& p);
std::string info_tables(const ReportInfo& info);

}  // namespace troffer
