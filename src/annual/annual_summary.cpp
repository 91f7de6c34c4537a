#include "annual/annual_summary.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "report/html_text.h"
#include "report/page_tables.h"

namespace troffer {

namespace {

constexpr double most_spacing = 0.61;  // m, two feet [2]
constexpr const char* no_level = "none";

std::string cell(const std::string& html) {
  return "<span class=\"n\">" + html + "</span>";
}

const YearFigure* figure_named(const AnnualGrid& g, const std::string& key) {
  for (const GridFigure& f : g.result.figures)
    if (f.key == key) return &f.figure;
  return nullptr;
}

// "2", or "1 or 2" while a requirement is undecided.
template <class Name>
std::string level_text(const ReachedLevel& reached, const Name& name) {
  if (reached.sure == reached.possible) return name(reached.sure);
  return name(reached.sure) + " or " + name(reached.possible);
}

std::string points_text(int points) {
  return points == 0 ? "0 points" : fmt::format("{} point{}", points, points > 1 ? "s" : "");
}

std::string level_17037(int level) {
  return std::vector<std::string>{no_level, "minimum", "medium", "high"}[size_t(level)];
}

std::string grids_table(const AnnualReport& r) {
  HtmlTable table({"Grid", "Sensors", "sDA", "LEED option 1", "ASE", "LEED option 2", "EN 17037"});
  const auto row = [&](const AnnualGrid& g) {
    const YearFigure& sda = *figure_named(g, "sda");
    const YearFigure& ase = *figure_named(g, "ase");
    const bool has_option_2 = figure_named(g, "leed_option_2") != nullptr;
    table.add({html_name(g.name), cell(std::to_string(g.count)), cell(year_figure_text(sda, "%")),
               level_text(level_reached(g.result, YearScheme::leed_option_1), points_text),
               cell(year_figure_text(ase, "%")),
               has_option_2
                   ? level_text(level_reached(g.result, YearScheme::leed_option_2), points_text)
                   : "no equinox",
               level_text(level_reached(g.result, YearScheme::en_17037), level_17037)});
  };
  for (const AnnualGrid& g : r.grids) row(g);
  if (r.grids.size() > 1) {
    std::vector<YearFigure> sda, ase;
    std::vector<size_t> counts;
    for (const AnnualGrid& g : r.grids) {
      sda.push_back(*figure_named(g, "sda"));
      ase.push_back(*figure_named(g, "ase"));
      counts.push_back(g.count);
    }
    const YearFigure all = joint_figure(sda, counts);
    GridResult joint;
    for (const auto& [least, points] : {std::pair{40, 1}, {55, 2}, {75, 3}})
      joint.requirements.push_back(
          {YearScheme::leed_option_1, points, "", "", all, year_verdict(all, least, true)});
    table.add({"All, by sensors", cell(std::to_string(r.points.size())),
               cell(year_figure_text(all, "%")),
               level_text(level_reached(joint, YearScheme::leed_option_1), points_text),
               cell(year_figure_text(joint_figure(ase, counts), "%")), "", ""});
  }
  return table.html();
}

// Returns a table of the conditions that LEED option 1 sets for the calculation [1, 2].
std::string conditions_table(const AnnualReport& r) {
  HtmlTable table({"Condition of LEED v4.1, option 1", "Here", ""});
  const auto add = [&](const char* name, const std::string& here, bool is_met) {
    table.add({html_text(name), html_text(here),
               year_verdict_mark(is_met ? YearVerdict::met : YearVerdict::not_met)});
  };
  const size_t days = r.year.steps.size() / 24 / size_t(r.year.steps_per_hour);
  add("Weather of a whole year", fmt::format("{} days", days), days >= 365);
  add("Occupied from 8 to 18 h on every day", r.occupancy, r.occupancy == "8-18");
  add("Daylight autonomy from 300 lx on", fmt::format("{:g} lx", r.da_lx), r.da_lx == 300);
  const bool has_blinds = has_several_states(r.paths);
  add("Blinds close against the sun, by IES LM-83",
      has_blinds ? r.blinds : "the model has no blinds", has_blinds && r.blinds == "lm-83");
  double spacing = 0;
  for (const AnnualGrid& g : r.grids) spacing = std::max(spacing, grid_spacing(r, g));
  add("Sensors at most 0.61 m apart", fmt::format("{:.2f} m", spacing),
      spacing <= most_spacing + 1e-3);
  return table.html();
}

}  // namespace

std::string year_figure_text(const YearFigure& f, const std::string& unit) {
  // A count of sensors may agree in all replicates; its error is then below one sensor.
  const std::string value =
      f.error > 0 ? with_error(f.value, f.error) : fmt::format("{:.4g}", f.value);
  return html_text(value + " " + unit);
}

std::string year_verdict_mark(YearVerdict v) {
  const char* style = v == YearVerdict::met ? "pass" : v == YearVerdict::not_met ? "fail" : "open";
  return fmt::format("<span class=\"{}\">{}</span>", style, verdict_name(v));
}

double grid_spacing(const AnnualReport& r, const AnnualGrid& g) {
  if (g.count < 2) return 0;
  const auto position = [&](size_t i) { return r.points[g.first + i].position; };
  std::vector<size_t> order(g.count);
  std::iota(order.begin(), order.end(), size_t(0));
  std::sort(order.begin(), order.end(), [&](size_t a, size_t b) {
    return std::pair(position(a).x, a) < std::pair(position(b).x, b);
  });
  double largest = 0;
  for (size_t k = 0; k < order.size(); ++k) {
    double nearest = INFINITY;
    // Sensors are sorted by x, so those further along than `nearest` need no look.
    const auto look = [&](size_t other) {
      const Vec3d d = position(order[other]) - position(order[k]);
      nearest = std::min(nearest, length(d));
      return std::abs(d.x) <= nearest;
    };
    for (size_t i = k + 1; i < order.size() && look(i);) ++i;
    for (size_t i = k; i > 0 && look(i - 1);) --i;
    largest = std::max(largest, nearest);
  }
  return largest;
}

std::string summary_section(const AnnualReport& r) {
  return "<h2>Summary</h2>" + grids_table(r) +
         "<p class=\"sub\">LEED option 1 counts the mean sDA of all regularly occupied rooms. "
         "Where "
         "ASE exceeds 10 %, the submission tells how glare is addressed. \"1 or 2\" means that "
         "more "
         "gather rays would decide.</p>" +
         conditions_table(r);
}

}  // namespace troffer
