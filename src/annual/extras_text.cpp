#include "annual/extras_text.h"

#include <fmt/format.h>

#include "annual/annual_plots.h"
#include "report/html_text.h"
#include "report/page_style.h"
#include "report/page_tables.h"

namespace troffer {

namespace {

std::string place_text(const MeasuringPoint& p) {
  return fmt::format("{:.2f}, {:.2f}, {:.2f}", p.position.x, p.position.y, p.position.z);
}

std::string number_cell(const std::string& text) {
  return "<span class=\"n\">" + html_text(text) + "</span>";
}

std::string glare_section(const AnnualReport& r) {
  if (r.extras.eyes.empty()) return "";
  HtmlTable table({"Eye", "At", "Looks towards", "DGP above .35", "above .40", "above .45",
                   "Protection from glare, EN 17037"});
  size_t number = 0;
  for (const EyeYear& e : r.extras.eyes) {
    std::vector<std::string> row{number_cell(fmt::format("{}", ++number)),
                                 html_text(place_text(e.eye)),
                                 html_text(fmt::format("{:.2f}, {:.2f}, {:.2f}", e.eye.normal.x,
                                                       e.eye.normal.y, e.eye.normal.z))};
    for (const double share : e.shares)
      row.push_back(number_cell(fmt::format("{:.1f} %", 100 * share)));
    row.push_back(html_text(glare_level(e)));
    table.add(row);
  }
  std::string h =
      "<h2>Daylight glare</h2><p class=\"sub\">Shares of the occupied hours with a Daylight Glare "
      "Probability above each limit, with blinds as they are operated. EN 17037 asks for at most 5 "
      "%: .45 minimum, .40 medium, .35 high.</p>" +
      table.html() + "<figure>" + eyes_plan(r, half_width) +
      "<figcaption>Eyes on the grids, with the direction in which each looks. Green: high "
      "protection from glare; olive: medium; orange: minimum; red: none.</figcaption></figure>";
  number = 0;
  for (const EyeYear& e : r.extras.eyes)
    h += "<figure>" + day_hour_map(r, e.dgp, "", {0.2, 0.5}, "Daylight Glare Probability") +
         fmt::format(
             "<figcaption>DGP of eye {} at {}, by day and hour of standard "
             "time.</figcaption></figure>",
             ++number, html_text(place_text(e.eye)));
  return h;
}

std::string sunlight_section(const AnnualReport& r) {
  if (r.extras.sunlight.empty()) return "";
  HtmlTable table({"Point", "Sunlight", "Level, EN 17037"});
  for (const SunlitPoint& p : r.extras.sunlight)
    table.add({html_text(place_text(p.point)), number_cell(fmt::format("{:.1f} h", p.hours)),
               html_text(sunlight_level(p.hours))});
  const SunlightDay& d = r.extras.sunlight_day;
  return fmt::format(
             "<h2>Exposure to sunlight</h2><p class=\"sub\">On {:02}-{:02} under a cloudless sky, "
             "with the sun {:g}° or more above the horizon. Minimum 1.5 h, medium 3 h, high 4 "
             "h.</p>",
             d.month, d.day, d.least_altitude_deg) +
         table.html();
}

std::string electric_section(const AnnualReport& r) {
  if (r.extras.electric.empty()) return "";
  HtmlTable table({"Group", "Sensors", "Electric light", "Occupied hours", "Hours of full output",
                   "Saved by daylight"});
  for (const DimmedUse& u : r.extras.electric)
    table.add(
        {html_name(u.name), number_cell(fmt::format("{}", u.sensors)),
         number_cell(fmt::format("{:.0f} lx", u.mean_lx)),
         number_cell(fmt::format("{:.0f} h", u.occupied_hours)),
         number_cell(fmt::format("{:.0f} h", u.full_load_hours)),
         number_cell(fmt::format("{:.0f} %", 100 * (1 - u.full_load_hours / u.occupied_hours)))});
  std::string short_of;  // groups that do not reach the target
  for (const DimmedUse& u : r.extras.electric)
    if (u.sensors > 0 && u.mean_lx < r.extras.electric_target_lx)
      short_of += (short_of.empty() ? "" : ", ") + html_name(u.name);
  if (!short_of.empty())
    short_of = fmt::format(
        "<p class=\"sub\">At night the target is not reached, even at full output, by {}.</p>",
        short_of);
  return fmt::format(
             "<h2>Electric light</h2><p class=\"sub\">Each group is dimmed so that the mean of the "
             "sensors that it lights most reaches {:g} lx.</p>",
             r.extras.electric_target_lx) +
         table.html() + short_of;
}

}  // namespace

std::string glare_csv(const AnnualReport& r) {
  std::string out = "hour_of_year";
  for (size_t k = 1; k <= r.extras.eyes.size(); ++k)
    out += fmt::format(",vertical_lx_{0},dgp_{0}", k);
  out += "\n";
  for (size_t h = 0; h < r.result.skies.hours(); ++h) {
    out += fmt::format("{:.10g}", r.year.steps[r.result.skies.steps[h]].hour_of_year);
    for (const EyeYear& e : r.extras.eyes)
      out += fmt::format(",{:.6g},{:.4f}", e.vertical_lx[h], e.dgp[h]);
    out += "\n";
  }
  return out;
}

std::string electric_csv(const AnnualReport& r) {
  std::string out = "grid,x,y,z";
  for (const ElectricLight& l : r.extras.lights)
    out += "," + csv_field(l.name) + "," + csv_field(l.name + " error");
  out += "\n";
  for (const AnnualGrid& g : r.grids)
    for (size_t s = g.first; s < g.first + g.count; ++s) {
      const Vec3d& p = r.points[s].position;
      out += fmt::format("{},{:.9g},{:.9g},{:.9g}", csv_field(g.name), p.x, p.y, p.z);
      for (const ElectricLight& l : r.extras.lights)
        out += fmt::format(",{:.6g},{:.3g}", l.lx[s], l.error[s]);
      out += "\n";
    }
  return out;
}

std::string extras_sections(const AnnualReport& r) {
  return glare_section(r) + sunlight_section(r) + electric_section(r);
}

}  // namespace troffer
