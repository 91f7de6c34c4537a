#include "report/comparison.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "report/checks.h"
#include "report/html_text.h"
#include "report/page_tables.h"
#include "report/plan_view.h"
#include "report/report.h"

namespace troffer {

namespace {

std::string cell_of(const std::optional<Figure>& f) {
  return f ? figure_cell(*f) : "–";
}

// Formats own minus other; bold if it exceeds two standard errors.
std::string difference(const std::optional<Figure>& other, const std::optional<Figure>& own) {
  if (!other || !own) return "–";
  const Figure d{own->value - other->value, std::hypot(own->error, other->error)};
  const double size = std::max(std::abs(own->value), std::abs(other->value));
  std::string text = with_error(std::abs(d.value), d.error);
  if (d.value != 0) text = (d.value < 0 ? "−" : "+") + text;
  const bool is_clear = std::abs(d.value) > 2 * d.error && std::abs(d.value) > 1e-9 * size;
  return fmt::format("<span class=\"n\">{}{}{}</span>", is_clear ? "<b>" : "", text,
                     is_clear ? "</b>" : "");
}

std::string verdict_of(const OtherReport& other, const std::string& subject) {
  std::string worst = "–";
  for (const OtherCheck& c : other.checks) {
    if (c.subject != subject || c.quantity == "Ēz" || c.quantity == "U0 of Ez") continue;
    if (c.verdict == "fail") return verdict_mark(Verdict::fail);
    if (c.verdict == "open") worst = verdict_mark(Verdict::open);
    if (c.verdict == "pass" && worst == "–") worst = verdict_mark(Verdict::pass);
  }
  return worst;
}

// Converts this report's figures to the form of the other report, so that both are treated alike.
OtherReport own_of(const Report& r) {
  const Assessment& a = r.assessment;
  OtherReport own;
  own.title = r.info.title;
  for (size_t i = 0; i < a.surfaces.size(); ++i) {
    OtherSurface s;
    s.name = a.surfaces[i].surface.name;
    const GridSummary sums = summary_of(assessed_light(a.surfaces[i]));
    if (sums.has_values) {
      s.mean = sums.mean;
      s.uniformity = sums.uniformity;
    }
    if (const Glare* worst = worst_glare(a, i)) s.ugr = worst->ugr;
    own.surfaces.push_back(std::move(s));
  }
  for (const Check& c : a.checks)
    own.checks.push_back({c.subject, c.quantity,
                          c.verdict == Verdict::pass   ? "pass"
                          : c.verdict == Verdict::fail ? "fail"
                                                       : "open",
                          c.required});
  const PowerResult& p = a.power;
  own.lumens = p.lumens;
  own.watts = p.watts;
  own.task_mean = p.task_mean;
  if (p.floor_area > 0) own.floor_area = p.floor_area;
  if (p.watts && p.floor_area > 0) {
    own.watts_per_m2 = *p.watts / p.floor_area;
    if (p.task_mean.value > 0)
      own.watts_per_100_lx = ratio({*own.watts_per_m2 * 100, 0}, p.task_mean);
  }
  return own;
}

const OtherSurface* find_surface(const OtherReport& r, const std::string& name) {
  const auto at = std::find_if(r.surfaces.begin(), r.surfaces.end(),
                               [&](const OtherSurface& s) { return s.name == name; });
  return at == r.surfaces.end() ? nullptr : &*at;
}

std::string surfaces_table(const OtherReport& other, const OtherReport& own) {
  HtmlTable t({"Surface", "Ē, lx: A", "B", "B − A", "U<sub>0</sub>: A", "B", "B − A", "UGR: A", "B",
               "B − A", "Verdict: A", "B"},
              "dense wide");
  std::vector<std::string> names;
  for (const OtherReport* r : {&own, &other})
    for (const OtherSurface& s : r->surfaces)
      if (std::find(names.begin(), names.end(), s.name) == names.end()) names.push_back(s.name);
  const OtherSurface none;
  for (const std::string& name : names) {
    const OtherSurface *a = find_surface(other, name), *b = find_surface(own, name);
    std::vector<std::string> cells{html_name(name)};
    for (const auto member : {&OtherSurface::mean, &OtherSurface::uniformity, &OtherSurface::ugr}) {
      const auto &x = (a != nullptr ? *a : none).*member, &y = (b != nullptr ? *b : none).*member;
      cells.insert(cells.end(), {cell_of(x), cell_of(y), difference(x, y)});
    }
    cells.push_back(a != nullptr ? verdict_of(other, name) : "not included");
    cells.push_back(b != nullptr ? verdict_of(own, name) : "not included");
    t.add(cells);
  }
  return t.html();
}

std::string power_rows(const OtherReport& other, const OtherReport& own) {
  HtmlTable t({"Quantity", "A", "B", "B − A"});
  const auto exact = [](const std::optional<double>& v) {
    return v ? std::optional<Figure>({*v, 0}) : std::nullopt;
  };
  const auto add = [&](const char* name, const std::optional<Figure>& a,
                       const std::optional<Figure>& b) {
    t.add({name, cell_of(a), cell_of(b), difference(a, b)});
  };
  add("Luminous flux, lm", exact(other.lumens), exact(own.lumens));
  add("Power, W", exact(other.watts), exact(own.watts));
  add("Floor area, m²", exact(other.floor_area), exact(own.floor_area));
  add("Power density, W/m²", exact(other.watts_per_m2), exact(own.watts_per_m2));
  add("Mean illuminance of tasks, lx", other.task_mean, own.task_mean);
  add("W/m² per 100 lx", other.watts_per_100_lx, own.watts_per_100_lx);
  return "<div class=\"keep\">" + t.html() + "</div>";
}

// Lists the requirements that differ between the two reports. Verdicts on them cannot be compared.
std::string differing_requirements(const OtherReport& other, const OtherReport& own) {
  std::string list;
  for (const OtherCheck& b : own.checks)
    for (const OtherCheck& a : other.checks)
      if (a.subject == b.subject && a.quantity == b.quantity && a.required != b.required)
        list += fmt::format("<li>{}, {}: A requires {:.4g}, B {:.4g}</li>", html_name(b.subject),
                            html_text(b.quantity), a.required, b.required);
  return list.empty() ? ""
                      : "<p>The two reports have different requirements:</p><ul class=\"notes\">" +
                            list + "</ul>\n";
}

std::string image_cell(const std::vector<uint8_t>& bytes, const char* type, const char* caption) {
  const std::string image = bytes.empty()
                                ? "<p class=\"sub\">none</p>"
                                : fmt::format("<img alt=\"{}\" src=\"data:image/{};base64,{}\">",
                                              caption, type, base64(bytes));
  return fmt::format("<figure>{}<figcaption>{}</figcaption></figure>", image, caption);
}

std::string images(const char* type, const std::vector<uint8_t>& a, const std::vector<uint8_t>& b) {
  if (a.empty() && b.empty()) return {};
  return "<div class=\"pair\">" + image_cell(a, type, "A") + image_cell(b, type, "B") + "</div>\n";
}

}  // namespace

std::string comparison_section(const Report& r, const OtherReport& other) {
  const OtherReport own = own_of(r);
  std::string h =
      "<h2>Comparison</h2>\n<p>A: " + html_text(other.title) + ". B: " + html_text(own.title) +
      " (this report). Differences in bold are larger than their uncertainty.</p>\n" +
      surfaces_table(other, own) + differing_requirements(other, own) + power_rows(other, own);
  const std::vector<std::string> plans = report_plans(r);
  const std::vector<uint8_t> plan = plans.empty()
                                        ? std::vector<uint8_t>{}
                                        : std::vector<uint8_t>(plans[0].begin(), plans[0].end());
  h += images("svg+xml", other.plan, plan);
  const bool has_picture = !r.pictures.empty();
  h += images("png", other.picture, has_picture ? r.pictures[0].seen : std::vector<uint8_t>{});
  h += images("png", other.luminance,
              has_picture ? r.pictures[0].luminances : std::vector<uint8_t>{});
  return h;
}

}  // namespace troffer
