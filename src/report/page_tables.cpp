#include "report/page_tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "report/checks.h"
#include "report/html_text.h"

namespace troffer {

namespace {

std::string place_cell(const Vec3d& p) {
  return fmt::format("<span class=\"n\">{:.2f}, {:.2f}, {:.2f}</span>", p.x + 0.0, p.y + 0.0,
                     p.z + 0.0);
}

std::string with_unit(const std::string& text, const std::string& unit) {
  return unit.empty() ? text : text + " " + html_text(unit);
}

// Formats a direction: "+x" along an axis, else three numbers.
std::string direction_cell(const Vec3d& d) {
  constexpr double along = 0.9999;
  for (size_t k = 0; k < 3; ++k)
    if (std::abs(d[k]) > along) return fmt::format("{}{}", d[k] > 0 ? "+" : "−", "xyz"[k]);
  return place_cell(d);
}

const Check* find_check(const Assessment& a, const std::string& subject, const char* quantity) {
  for (const Check& c : a.checks)
    if (c.subject == subject && c.quantity == quantity) return &c;
  return nullptr;
}

// Formats a value in the colour of its verdict, with the requirement.
std::string checked_cell(const Check* c, const Figure& value, const char* unit) {
  const std::string text = with_unit(figure_cell(value), unit);
  if (c == nullptr) return text;
  const char* style = c->verdict == Verdict::pass   ? "pass"
                      : c->verdict == Verdict::fail ? "fail"
                                                    : "open";
  return fmt::format("<span class=\"{}\">{}</span> <span class=\"ask\">{} {:.4g}</span>", style,
                     text, c->is_most ? "≤" : "≥", c->required);
}

std::string verdict_of_all(const std::vector<const Check*>& checks) {
  bool is_any = false, is_open = false;
  for (const Check* c : checks) {
    if (c == nullptr) continue;
    is_any = true;
    if (c->verdict == Verdict::fail) return verdict_mark(Verdict::fail);
    is_open = is_open || c->verdict == Verdict::open;
  }
  return !is_any ? "no requirement" : verdict_mark(is_open ? Verdict::open : Verdict::pass);
}

void add_surface(const Report& r, size_t i, HtmlTable& t) {
  const Assessment& a = r.assessment;
  const SurfaceResult& s = a.surfaces[i];
  const GridSummary sums = summary_of(assessed_light(s));
  const Check *mean = find_check(a, s.surface.name, "Ēm"),
              *even = find_check(a, s.surface.name, "U0"),
              *ugr = find_check(a, s.surface.name, "UGR");
  const Glare* worst = worst_glare(a, i);
  const Profile* p = find_profile(r.options.profiles, s.surface.profile);
  t.add({html_name(s.surface.name), html_text(p != nullptr ? p->name : s.surface.profile),
         sums.has_values ? checked_cell(mean, sums.mean, "lx") : "–",
         sums.has_values ? checked_cell(even, sums.uniformity, "") : "–",
         worst == nullptr ? "–" : checked_cell(ugr, worst->ugr, ""),
         verdict_of_all({mean, even, ugr})});
}

}  // namespace

HtmlTable::HtmlTable(const std::vector<std::string>& head, const std::string& style) {
  html_ = "<div class=\"table\"><table" + (style.empty() ? "" : " class=\"" + style + "\"") +
          "><thead><tr>";
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

const char* verdict_mark(Verdict v) {
  return v == Verdict::pass   ? "<span class=\"pass\">met</span>"
         : v == Verdict::fail ? "<span class=\"fail\">not met</span>"
                              : "<span class=\"open\">undecided</span>";
}

std::string summary_matrix(const Report& r) {
  const Assessment& a = r.assessment;
  HtmlTable t({"Surface", "Task", a.has_electric ? "Mean Ē<sub>m</sub>" : "Mean Ē",
               "Uniformity U<sub>0</sub>", "Glare UGR", "Verdict"},
              "wide dense matrix");
  std::set<std::string> names;
  for (size_t i = 0; i < a.surfaces.size(); ++i) {
    names.insert(a.surfaces[i].surface.name);
    add_surface(r, i, t);
  }
  for (const Check& c : a.checks) {
    const bool is_cylinder = c.quantity == "Ēz",
               is_observer = !names.contains(c.subject) && c.quantity == "UGR";
    if (!is_cylinder && !is_observer) continue;
    const Check* even = is_cylinder ? find_check(a, c.subject, "U0 of Ez") : nullptr;
    t.add({html_name(c.subject),
           is_cylinder ? "Cylindrical illuminance at eye height" : "Observers",
           is_cylinder ? checked_cell(&c, c.value, "lx") : "–",
           even != nullptr ? checked_cell(even, even->value, "") : "–",
           is_observer ? checked_cell(&c, c.value, "") : "–", verdict_of_all({&c, even})});
  }
  return t.html();
}

std::string undecided_list(const Report& r) {
  std::string list;
  for (const Check& c : r.assessment.checks) {
    if (c.verdict != Verdict::open) continue;
    const std::optional<double> samples = samples_to_decide(c, r.options.measure.spp);
    list += "<li>" + html_name(c.subject) + ", " + html_text(c.quantity) + ": " +
            with_unit(figure_cell(c.value), c.unit) + fmt::format(" against {:.4g}. ", c.required);
    if (samples)
      list +=
          fmt::format("About {:.0f} samples per point would decide (<code>--spp {:.0f}</code>).",
                      *samples, std::ceil(*samples / 256) * 256);
    else
      list += "The value is so close to the requirement that no number of samples can decide.";
    list += "</li>\n";
  }
  if (list.empty()) return {};
  return fmt::format(
             "<p>Undecided: the value is closer to the requirement than its uncertainty "
             "allows. This report took {} samples per point.</p>\n<ul class=\"notes\">",
             r.options.measure.spp) +
         list + "</ul>\n";
}

std::string figures_table(const SurfaceResult& s) {
  HtmlTable t({"", "Mean Ē", "Minimum", "Maximum", "U<sub>0</sub>"}, "dense wide");
  const auto add = [&](const char* name, const std::vector<Figure>& values) {
    const GridSummary g = summary_of(values);
    if (!g.has_values) return;
    t.add({name, figure_cell(g.mean), figure_cell(g.least), figure_cell(g.most),
           figure_cell(g.uniformity)});
  };
  add("lx", s.electric);
  add("daylight, lx", s.daylight);
  add("daylight factor, %", s.factor);
  return t.html();
}

std::string contributions_table(const Assessment& a) {
  const auto luminaires = std::count_if(a.groups.begin(), a.groups.end(),
                                        [](const ReportedLights& g) { return !g.is_daylight; });
  if (luminaires < 2 || a.surfaces.empty() || a.surfaces[0].by_group.empty()) return {};
  std::vector<std::string> head{"Surface"};
  for (const ReportedLights& g : a.groups)
    if (!g.is_daylight)
      head.push_back(html_name(g.name) +
                     (g.luminaires > 1 ? fmt::format(" ({})", g.luminaires) : ""));
  head.insert(head.end(), {"Sum", "All together"});
  HtmlTable t(head, "dense wide");
  for (const SurfaceResult& s : a.surfaces) {
    std::vector<std::string> cells{html_name(s.surface.name)};
    Figure all;
    for (size_t g = 0; g < a.groups.size(); ++g) {
      if (a.groups[g].is_daylight) continue;
      cells.push_back("<span class=\"n\">" + short_number(s.by_group[g].value) + "</span>");
      all = sum(all, s.by_group[g]);
    }
    cells.push_back("<span class=\"n\">" + short_number(all.value) + "</span>");
    cells.push_back(figure_cell(mean_of(s.electric)));
    t.add(cells);
  }
  return t.html();
}

std::string glare_table(const Assessment& a) {
  HtmlTable t({"Surface", "Worst UGR", "Eye x, y, z", "View direction", "Background", "Main source",
               "Other ratings"},
              "wide");
  std::vector<size_t> subjects;
  for (size_t i = 0; i < a.surfaces.size(); ++i) subjects.push_back(i);
  subjects.push_back(no_surface);
  for (const size_t i : subjects) {
    const Glare* worst = worst_glare(a, i);
    std::string others;
    size_t unseen = 0;
    for (const GlareResult& g : a.glares) {
      if (g.surface != i || &g.glare == worst) continue;
      if (g.glare.is_defined)
        others += (others.empty() ? "" : ", ") + fmt::format("{:.1f}", g.glare.ugr.value);
      else
        ++unseen;
    }
    if (unseen > 0)
      others += (others.empty() ? "" : ", ") + fmt::format("{} without glare", unseen);
    const std::string name = i == no_surface ? "observers" : html_name(a.surfaces[i].surface.name);
    if (worst == nullptr) {
      if (!others.empty()) t.add({name, "–", "–", "–", "–", "no luminaire in view", others});
      continue;
    }
    t.add({name, figure_cell(worst->ugr) + (worst->is_large ? " *" : ""),
           place_cell(worst->observer.position), direction_cell(worst->observer.direction),
           figure_cell(worst->background) + " cd/m²", html_name(worst->luminaires.front().name),
           others});
  }
  return t.html();
}

std::string cylinder_table(const Assessment& a) {
  HtmlTable t({"Above", "Mean Ē<sub>z</sub>", "Minimum", "Uniformity",
               "Modelling Ē<sub>z</sub>/Ē<sub>h</sub>", "Positions"},
              "wide");
  for (size_t f = 0; f < a.floors.size(); ++f) {
    std::vector<Figure> cylindrical, horizontal;
    for (const CylinderResult& c : a.cylinders) {
      if (c.floor != f) continue;
      cylindrical.push_back(c.cylindrical);
      horizontal.push_back(c.horizontal);
    }
    if (cylindrical.empty()) continue;
    const GridSummary s = summary_of(cylindrical);
    t.add({html_name(a.floors[f].name), figure_cell(s.mean) + " lx", figure_cell(s.least) + " lx",
           figure_cell(s.uniformity), figure_cell(ratio(s.mean, mean_of(horizontal))),
           std::to_string(cylindrical.size())});
  }
  return t.html();
}

std::string luminaires_table(const Assessment& a, const Vec3d& up,
                             const std::vector<size_t>& types) {
  constexpr size_t most = 60;
  HtmlTable t({"No.", "Name", "Type", "x, y, z in m", "Aim", "Flux", "Power"}, "wide dense");
  for (size_t i = 0; i < std::min(a.luminaires.size(), most); ++i) {
    const PlacedLuminaire& l = a.luminaires[i];
    const double down = -dot(l.aim, up);
    t.add({std::to_string(i + 1), html_name(l.name), std::string(1, char('A' + types[i] % 26)),
           place_cell(l.position),
           !(length(l.aim) > 0) ? "all directions"
           : down > 0.9999      ? "down"
           : down < -0.9999     ? "up"
                                : direction_cell(l.aim),
           "<span class=\"n\">" + short_number(l.lumens) + " lm</span>",
           l.watts ? "<span class=\"n\">" + short_number(*l.watts) + " W</span>" : "unknown"});
  }
  std::string h = t.html();
  if (a.luminaires.size() > most)
    h += fmt::format("<p class=\"sub\">{} more are in report.json.</p>\n",
                     a.luminaires.size() - most);
  return h;
}

std::string daylight_table(const Assessment& a) {
  std::string list;
  for (const ReportedLights& g : a.groups)
    if (g.is_daylight) list += (list.empty() ? "" : ", ") + html_name(g.name);
  return list.empty() ? "" : "<p>Daylight: " + list + ".</p>\n";
}

std::string power_table(const PowerResult& p) {
  const bool is_known = p.watts && p.floor_area > 0;
  const double per_area = is_known ? *p.watts / p.floor_area : 0;
  HtmlTable t({"Quantity", "Value"});
  t.add({"Luminous flux, initial", short_number(p.lumens) + " lm"});
  t.add({"Power", p.watts ? short_number(*p.watts) + " W"
                          : "unknown: no photometric file states it (give it with --power)"});
  t.add({"Floor area within the walls",
         p.floor_area > 0 ? fmt::format("{:.2f} m²", p.floor_area) : "no floor was found"});
  t.add({"Power density", is_known ? fmt::format("{:.2f} W/m²", per_area) : "–"});
  t.add({"Mean maintained illuminance of tasks", figure_cell(p.task_mean) + " lx"});
  t.add({"Power density per 100 lx",
         is_known && p.task_mean.value > 0
             ? figure_cell(ratio({per_area * 100, 0}, p.task_mean)) + " W/m² per 100 lx"
             : "–"});
  return "<div class=\"keep\">" + t.html() + "</div>";
}

std::string bias_table(const Assessment& a) {
  HtmlTable t(
      {"Surface", "Bias of the minimum: electric, lx", "daylight, lx", "daylight factor, %"},
      "dense");
  for (const SurfaceResult& s : a.surfaces) {
    const auto cell = [](const std::vector<Figure>& values) {
      const GridSummary g = summary_of(values);
      return g.has_values ? fmt::format("{:.2g}", g.least_bias + 0.0) : std::string("–");
    };
    t.add({html_name(s.surface.name), cell(s.electric), cell(s.daylight), cell(s.factor)});
  }
  return t.html();
}

std::string info_tables(const ReportInfo& info) {
  HtmlTable t({"Setting", "Value"}, "dense");
  t.add({"Program", "troffer " + html_text(info.version)});
  t.add({"Command", "<code>" + html_text(info.command) + "</code>"});
  t.add({"Scene", html_name(info.scene)});
  for (const auto& [name, value] : info.settings) t.add({html_text(name), html_text(value)});
  HtmlTable files({"Input", "Bytes", "SHA-256"}, "dense");
  for (const InputHash& h : info.inputs)
    files.add({html_name(h.file), std::to_string(h.bytes), "<code>" + h.sha256 + "</code>"});
  return t.html() + (info.inputs.empty() ? "" : files.html());
}

}  // namespace troffer
