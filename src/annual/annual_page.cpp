#include "annual/annual_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "annual/annual_plots.h"
#include "annual/annual_summary.h"
#include "annual/extras_text.h"
#include "report/html_text.h"
#include "report/page_style.h"
#include "report/page_tables.h"

namespace troffer {

namespace {

std::string figures_table_of(const AnnualGrid& g) {
  HtmlTable table({"Figure", "Value"});
  for (const GridFigure& f : g.result.figures)
    table.add({html_text(f.title),
               "<span class=\"n\">" + year_figure_text(f.figure, f.unit) + "</span>"});
  return table.html();
}

std::string requirements_table_of(const AnnualGrid& g) {
  HtmlTable table({"Requirement", "Needed", "Found", "Verdict"});
  for (const GridRequirement& r : g.result.requirements)
    table.add({html_text(r.title), "<span class=\"ask\">" + html_text(r.need) + "</span>",
               "<span class=\"n\">" + year_figure_text(r.figure, "%") + "</span>",
               year_verdict_mark(r.verdict)});
  return table.html();
}

// Upper end of a scale of illuminance: 98 % of the values lie below it, rounded up.
double high_end(std::span<const float> values) {
  std::vector<float> v(values.begin(), values.end());
  if (v.empty()) return 1;
  const auto at = v.begin() + std::ptrdiff_t(double(v.size() - 1) * 0.98);
  std::nth_element(v.begin(), at, v.end());
  const double power = std::pow(10.0, std::floor(std::log10(std::max(double(*at), 1.0))));
  return power * std::ceil(double(*at) / power);
}

std::string plan_figure(const AnnualReport& r, const AnnualGrid& g, SensorFigure figure) {
  const FigureColumn& column = figure_columns()[size_t(figure)];
  std::vector<double> values;
  std::vector<float> shown;
  for (size_t s = g.first; s < g.first + g.count; ++s) {
    values.push_back(r.result.figures.of(s, figure).value);
    shown.push_back(float(values.back()));
  }
  const bool is_share = std::string(column.unit) == "%";
  const ColourRange range{0, is_share ? 100 : high_end(shown)};
  return "<figure>" + grid_plan(r, g, values, column.unit, range, half_width) + "<figcaption>" +
         html_text(column.title) + "</figcaption></figure>";
}

std::string grid_section(const AnnualReport& r, const AnnualGrid& g) {
  std::string h = fmt::format(
      "<h2>{}</h2><p class=\"sub\">{} sensors, which stand for equal areas. "
      "Values after ± are standard errors.</p>",
      html_name(g.name), g.count);
  h += requirements_table_of(g);
  h += "<p class=\"sub\">A requirement is undecided if its limit lies within two standard errors. ";
  h += has_several_states(r.paths)
           ? "Blinds are operated for daylight autonomy, UDI, mean illuminance and sDA. ASE, EN "
             "17037 and LEED option 2 have them open.</p>"
           : "sDA is computed without blinds: LEED option 1 also asks for blinds to be "
             "operated.</p>";
  h += figures_table_of(g);
  h += "<div class=\"plots\">";
  for (const SensorFigure f : {SensorFigure::da, SensorFigure::udi_autonomous,
                               SensorFigure::mean_lx, SensorFigure::sun_hours})
    h += plan_figure(r, g, f);
  h += "</div>";
  h += "<figure>" +
       day_hour_map(r, g.mean_lx, "lx", {0, high_end(g.mean_lx)},
                    "Mean illuminance by day and hour") +
       "<figcaption>Mean illuminance of the grid, by day and hour of standard time. Grey: the sun "
       "is down.</figcaption></figure>";
  h += "<figure>" + day_hour_map(r, g.share_300, "%", {0, 100}, "Share of sensors from 300 lx on") +
       "<figcaption>Share of the grid with 300 lx or more.</figcaption></figure>";
  return h;
}

std::string blinds_text(const std::string& blinds) {
  if (blinds == "lm-83")
    return "IES LM-83: groups close while more than 2 % of a grid get 1000 lx or more straight "
           "from the sun";
  return blinds == "open" ? "always open" : "table " + blinds;
}

std::string groups_section(const AnnualReport& r) {
  if (r.paths.size() < 2) return "";
  HtmlTable table({"Window group", "State", "Occupied hours with daylight"});
  for (size_t p = 0; p < r.paths.size(); ++p) {
    if (r.paths[p].name == static_path) continue;
    const std::vector<double> hours = hours_in_states(r, p);
    for (size_t s = 0; s < hours.size(); ++s)
      table.add({s == 0 ? html_name(r.paths[p].name) : "", html_name(r.paths[p].states[s].name),
                 fmt::format("<span class=\"n\">{:.0f} h</span>", hours[s])});
  }
  return "<h2>Window groups</h2><p class=\"sub\">Operation of blinds: " +
         html_text(blinds_text(r.blinds)) + ".</p>" + table.html();
}

std::string settings_section(const AnnualReport& r) {
  const AnnualResult& result = r.result;
  HtmlTable table({"Setting", "Value"});
  const auto add = [&](const std::string& name, const std::string& value) {
    table.add({html_text(name), html_text(value)});
  };
  add("Scene", r.scene);
  add("Weather file", r.weather_file);
  add("Place", fmt::format("{}, latitude {:.2f}°, longitude {:.2f}°, UTC{:+g}", r.year.place,
                           r.year.latitude_deg, r.year.longitude_deg, r.year.zone_hours));
  add("Time steps", fmt::format("{}, of which {} with the sun up, {} occupied", r.year.steps.size(),
                                result.skies.hours(), result.times.occupied));
  add("Occupancy", r.occupancy);
  add("Threshold of daylight autonomy", fmt::format("{:g} lx", r.da_lx));
  add("North", fmt::format("{:g}° clockwise", r.north_deg));
  add("Sky", fmt::format("Perez all-weather, {} patches direct, 577 reflected",
                         result.skies.fine.sky.size()));
  add("Cells and light paths",
      fmt::format("{} cells, {} links, {} sources, {} replicates", result.cells, result.links,
                  result.sources, replicate_count));
  add("Standard error of one sensor in one hour",
      fmt::format("{:.2g} % of the illuminance, root mean square; most of it at edges of sunlight",
                  100 * result.relative_error));
  add("Program", "troffer " + r.version);
  add("Command", r.command);
  return "<h2>Settings</h2>" + table.html();
}

}  // namespace

std::string annual_page(const AnnualReport& r) {
  std::string h =
      "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><meta "
      "name=\"viewport\" content=\"width=device-width\"><title>" +
      html_text(r.title) + "</title><style>" + page_style + "</style></head><body>\n";
  h += "<h1>" + html_text(r.title) + "</h1><p class=\"sub\">A year of daylight, " +
       html_text(r.year.place) + "</p>";
  if (!r.warnings.empty()) {
    h += "<ul class=\"notes\">";
    for (const std::string& w : r.warnings) h += "<li>" + html_text(w) + "</li>";
    h += "</ul>";
  }
  h += summary_section(r);
  for (const AnnualGrid& g : r.grids) h += grid_section(r, g);
  h += groups_section(r);
  h += extras_sections(r);
  h += "<h2>Sun</h2><figure>" + sun_paths(r.year, half_width) +
       "<figcaption>Paths of the sun on the 21st of December to June, hours in standard "
       "time.</figcaption></figure>";
  h += settings_section(r);
  return h + "</body></html>\n";
}

}  // namespace troffer
