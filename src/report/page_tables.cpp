#include "report/page_tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "report/checks.h"
#include "report/html_text.h"

namespace troffer {

namespace {

std::string place_cell(const Vec3d& p) {
  return fmt::format("{:.2f}, {:.2f}, {:.2f}", p.x + 0.0, p.y + 0.0, p.z + 0.0);
}

std::string unit_after(const std::string& unit) {
  return unit.empty() ? "" : " " + html_text(unit);
}

const char* word_of(Verdict v) {
  return v == Verdict::pass   ? "<span class=\"pass\">pass</span>"
         : v == Verdict::fail ? "<span class=\"fail\">fail</span>"
                              : "<span class=\"open\">within 2 standard errors</span>";
}

std::string ugr_cell(const Glare& g) {
  if (!g.is_defined) return "–";
  return figure_cell(g.ugr) + (g.is_large ? " *" : "");
}

}  // namespace

HtmlTable::HtmlTable(const std::vector<std::string>& head) {
  html_ = "<div class=\"table\"><table><thead><tr>";
  for (const std::string& h : head) html_ += "<th>" + h + "</th>";
  html_ += "</tr></thead><tbody>\n";
}

void HtmlTable::add(const std::vector<std::string>& cells, const std::string& row_class) {
  html_ += row_class.empty() ? "<tr>" : "<tr class=\"" + row_class + "\">";
  for (const std::string& c : cells) html_ += "<td>" + c + "</td>";
  html_ += "</tr>\n";
}

std::string figure_cell(const Figure& f) {
  return "<span class=\"n\">" + with_error(f.value, f.error) + "</span>";
}

std::string checks_table(const Assessment& a, const std::vector<Profile>& profiles) {
  if (a.checks.empty()) return "<p>No requirement applies.</p>\n";
  HtmlTable t({"Surface", "Task", "Quantity", "Required", "Value", "Result"});
  for (const Check& c : a.checks) {
    const Profile* p = find_profile(profiles, c.profile);
    t.add({html_text(c.subject), html_text(p != nullptr ? p->name : c.profile),
           html_text(c.quantity),
           fmt::format("{} {:.4g}{}", c.is_most ? "≤" : "≥", c.required, unit_after(c.unit)),
           figure_cell(c.value) + unit_after(c.unit), word_of(c.verdict)});
  }
  return t.html();
}

std::string summary_table(const SurfaceResult& s) {
  HtmlTable t({"Light", "Mean Ē", "Least E<sub>min</sub>", "Largest E<sub>max</sub>",
               "Uniformity U<sub>0</sub>", "Bias of the least"});
  const auto add = [&](const char* name, const std::vector<Figure>& values, const char* unit) {
    const GridSummary g = summary_of(values);
    if (!g.has_values) return;
    t.add({name, figure_cell(g.mean) + unit, figure_cell(g.least) + unit,
           figure_cell(g.most) + unit, figure_cell(g.uniformity),
           fmt::format("{:.2g}{}", g.least_bias + 0.0, unit)});
  };
  add("Electric, maintained", s.electric, " lx");
  add("Daylight", s.daylight, " lx");
  add("Daylight factor", s.factor, " %");
  return t.html();
}

std::string contributions_table(const Assessment& a, const SurfaceResult& s) {
  const auto luminaires = std::count_if(a.groups.begin(), a.groups.end(),
                                        [](const ReportedLights& g) { return !g.is_daylight; });
  if (s.by_group.empty() || luminaires < 2) return {};
  const Figure mean = mean_of(s.electric);
  HtmlTable t({"Luminaires", "Mean by them alone", "Share"});
  Figure all;
  for (size_t g = 0; g < a.groups.size(); ++g) {
    if (a.groups[g].is_daylight) continue;
    const std::string count =
        a.groups[g].luminaires > 1 ? fmt::format(" ({})", a.groups[g].luminaires) : "";
    const Figure share = scaled(ratio(s.by_group[g], mean), 100);
    t.add({html_text(a.groups[g].name) + count, figure_cell(s.by_group[g]) + " lx",
           fmt::format("{:.1f} %", share.value)});
    all = sum(all, s.by_group[g]);
  }
  t.add({"Sum", figure_cell(all) + " lx", fmt::format("{:.1f} %", 100 * ratio(all, mean).value)},
        "sum");
  return t.html();
}

std::string glare_table(const Assessment& a) {
  HtmlTable t({"Surface", "Eye x, y, z", "Looks to", "L<sub>b</sub>", "UGR", "Most by"});
  for (const GlareResult& g : a.glares) {
    const bool is_worst =
        g.glare.is_defined && worst_glare(a, g.surface)->ugr.value == g.glare.ugr.value;
    const auto& seen = g.glare.luminaires;
    t.add({g.surface == no_surface ? "observer" : html_text(a.surfaces[g.surface].surface.name),
           place_cell(g.glare.observer.position), place_cell(g.glare.observer.direction),
           figure_cell(g.glare.background) + " cd/m²", ugr_cell(g.glare),
           seen.empty() ? "none is seen" : html_text(seen.front().name)},
          is_worst ? "worst" : "");
  }
  return t.html();
}

std::string cylinder_table(const Assessment& a) {
  HtmlTable t({"Above", "Mean Ē<sub>z</sub>", "Least", "Uniformity",
               "Modelling Ē<sub>z</sub>/Ē<sub>h</sub>", "Places"});
  for (size_t f = 0; f < a.floors.size(); ++f) {
    std::vector<Figure> cylindrical, horizontal;
    for (const CylinderResult& c : a.cylinders) {
      if (c.floor != f) continue;
      cylindrical.push_back(c.cylindrical);
      horizontal.push_back(c.horizontal);
    }
    if (cylindrical.empty()) continue;
    const GridSummary s = summary_of(cylindrical);
    t.add({html_text(a.floors[f].name), figure_cell(s.mean) + " lx", figure_cell(s.least) + " lx",
           figure_cell(s.uniformity), figure_cell(ratio(s.mean, mean_of(horizontal))),
           std::to_string(cylindrical.size())});
  }
  return t.html();
}

std::string luminaires_table(const Assessment& a) {
  HtmlTable t({"Luminaires", "Count", "Luminous flux", "Power", "Efficacy"});
  for (const ReportedLights& g : a.groups) {
    if (g.is_daylight) {
      t.add({html_text(g.name), std::to_string(g.luminaires), "daylight", "–", "–"});
      continue;
    }
    t.add({html_text(g.name), std::to_string(g.luminaires), short_number(g.lumens) + " lm",
           g.watts ? short_number(*g.watts) + " W" : "unknown",
           g.watts && *g.watts > 0 ? short_number(g.lumens / *g.watts) + " lm/W" : "–"});
  }
  return t.html();
}

std::string power_table(const PowerResult& p) {
  const bool is_known = p.watts && p.floor_area > 0;
  const double per_area = is_known ? *p.watts / p.floor_area : 0;
  HtmlTable t({"Quantity", "Value"});
  t.add({"Luminous flux, initial", short_number(p.lumens) + " lm"});
  t.add({"Power", p.watts ? short_number(*p.watts) + " W"
                          : "unknown (no photometric file tells it; --power does)"});
  t.add({"Floor area",
         p.floor_area > 0 ? fmt::format("{:.2f} m²", p.floor_area) : "no floor was found"});
  t.add({"Power density", is_known ? fmt::format("{:.2f} W/m²", per_area) : "–"});
  t.add({"Mean maintained illuminance of tasks", figure_cell(p.task_mean) + " lx"});
  t.add({"Power density per 100 lx",
         is_known && p.task_mean.value > 0
             ? figure_cell(ratio({per_area * 100, 0}, p.task_mean)) + " W/m² per 100 lx"
             : "–"});
  return t.html();
}

std::string info_tables(const ReportInfo& info) {
  HtmlTable t({"What", "How"});
  t.add({"Program", "troffer " + html_text(info.version)});
  t.add({"Command", "<code>" + html_text(info.command) + "</code>"});
  t.add({"Scene", html_text(info.scene)});
  for (const auto& [name, value] : info.settings) t.add({html_text(name), html_text(value)});
  HtmlTable files({"Input", "Bytes", "SHA-256"});
  for (const InputHash& h : info.inputs)
    files.add({html_text(h.file), std::to_string(h.bytes), "<code>" + h.sha256 + "</code>"});
  return t.html() + (info.inputs.empty() ? "" : files.html());
}

}  // namespace troffer
