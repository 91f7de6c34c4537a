#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "report/checks.h"
#include "report/comparison.h"
#include "report/grid_plot.h"
#include "report/html_text.h"
#include "report/page_style.h"
#include "report/page_tables.h"
#include "report/plan_plot.h"
#include "report/polar_plot.h"
#include "report/report.h"

namespace troffer {

namespace {

std::string count_of(const Assessment& a, Verdict v, const char* name) {
  const auto n = std::count_if(a.checks.begin(), a.checks.end(),
                               [&](const Check& c) { return c.verdict == v; });
  if (n == 0) return {};
  const char* style_of = v == Verdict::pass ? "pass" : v == Verdict::fail ? "fail" : "open";
  return fmt::format("<span class=\"{}\">{} {}</span> ", style_of, n, name);
}

std::string head(const Report& r) {
  const Assessment& a = r.assessment;
  std::string h = "<h1>" + html_text(r.info.title) + "</h1>\n<p class=\"sub\">Lighting report";
  if (!r.info.date.empty()) h += " · " + html_text(r.info.date);
  h += " · " + html_name(r.info.scene) + "</p>\n<p class=\"result\">";
  if (a.checks.empty())
    h += "No requirement applies.";
  else
    h += count_of(a, Verdict::pass, "requirements met") + count_of(a, Verdict::fail, "not met") +
         count_of(a, Verdict::open, "undecided");
  return h + "</p>\n";
}

// Colour rendering is a requirement on lamps; the program does not compute it.
std::string colour_rendering(const Report& r) {
  int most = 0;
  for (const SurfaceResult& s : r.assessment.surfaces)
    if (const Profile* p = find_profile(r.options.profiles, s.surface.profile))
      most = std::max(most, p->colour_rendering);
  return most == 0 ? ""
                   : fmt::format(
                         "<p class=\"sub\">Lamps should have R<sub>a</sub> ≥ {}; colour "
                         "rendering is not computed.</p>\n",
                         most);
}

std::string summary(const Report& r) {
  const Assessment& a = r.assessment;
  std::string h = "<h2>Summary</h2>\n<p class=\"sub\">";
  if (a.has_electric)
    h += fmt::format(
        "Electric light. Illuminances are maintained values: initial values × {:.2f}. UGR is for "
        "initial light, at the worst position.",
        r.options.maintenance);
  else
    h += "Daylight only: no luminaire is on.";
  return h + " ± is the uncertainty of the computation (see the appendix).</p>\n" +
         summary_matrix(r) + colour_rendering(r) + undecided_list(r);
}

std::string figure(const std::string& drawing, const std::string& caption, const char* style = "") {
  return fmt::format("<figure{}>", *style != '\0' ? fmt::format(" class=\"{}\"", style) : "") +
         drawing + (caption.empty() ? "" : "<figcaption>" + caption + "</figcaption>") +
         "</figure>\n";
}

std::string plans(const Report& r) {
  const std::vector<std::string> drawings = report_plans(r);
  std::string h = "<h2>Plan</h2>\n";
  for (size_t i = 0; i < drawings.size(); ++i)
    h += figure(drawings[i],
                (drawings.size() > 1 ? fmt::format("Storey {}. ", i + 1) : std::string()) +
                    "Floors within their walls, assessed surfaces (blue) and luminaires with their "
                    "numbers in the list (yellow).");
  return h;
}

// Returns 0 for values that would print as 0.00 or -0.00.
double near_zero(double v) {
  return std::abs(v) < 0.005 ? 0 : v;
}

std::string facts_of(const AssessedSurface& s, const SurfaceGrid& g) {
  std::string f = fmt::format("{:.2f} × {:.2f} m", s.width, s.height);
  if (std::abs(s.area - s.width * s.height) > 0.005) f += fmt::format(", {:.2f} m²", s.area);
  if (s.above_floor > 0) f += fmt::format(", {:.2f} m above the floor", s.above_floor);
  f += fmt::format("; {} points", g.points.size());
  if (s.border > 0) f += fmt::format(", {:.2f} m from the walls", s.border);
  return f + fmt::format("; origin at {:.2f}, {:.2f}, {:.2f}", near_zero(s.corner.x),
                         near_zero(s.corner.y), near_zero(s.corner.z));
}

// Colour scales, one for each quantity.
struct Scales {
  PlotScale electric, daylight, factor;
};

Scales scales_of(const Assessment& a) {
  Scales s;
  for (const SurfaceResult& r : a.surfaces) {
    widen(s.electric, r.electric);
    widen(s.daylight, r.daylight);
    widen(s.factor, r.factor);
  }
  return s;
}

std::string surface_section(const SurfaceResult& s, const Scales& scales) {
  struct Drawing {
    const std::vector<Figure>* values;
    const PlotScale* scale;
    const char* unit;
    const char* caption;
  };
  std::vector<Drawing> drawings;
  if (!s.electric.empty())
    drawings.push_back({&s.electric, &scales.electric, "lx", "Electric light, maintained, lx"});
  if (!s.daylight.empty())
    drawings.push_back({&s.daylight, &scales.daylight, "lx", "Daylight, lx"});
  if (!s.factor.empty()) drawings.push_back({&s.factor, &scales.factor, "%", "Daylight factor, %"});
  // A desk with one drawing takes half of the width; floors need all of it for their values.
  const bool is_large =
      s.surface.kind == SurfaceKind::floor || s.surface.kind == SurfaceKind::work_plane;
  const bool is_wide = is_large || drawings.size() > 1;
  const double width = is_wide && drawings.size() == 1 ? full_width : half_width;
  std::string h = fmt::format("<section class=\"surface{}\"><h3>", is_wide ? " wide" : "") +
                  html_name(s.surface.name) + "</h3>\n<p class=\"sub\">" +
                  facts_of(s.surface, s.grid) + ".</p>\n" + figures_table(s);
  if (drawings.size() > 1) h += "<div class=\"plots\">";
  for (const Drawing& d : drawings)
    h += figure(grid_plot(s.surface, s.grid, *d.values, d.unit, *d.scale, width),
                drawings.size() > 1 ? d.caption : "");
  if (drawings.size() > 1) h += "</div>";
  return h + "</section>\n";
}

std::string surfaces(const Report& r) {
  const Assessment& a = r.assessment;
  const Scales scales = scales_of(a);
  std::string h =
      "<h2>Surfaces</h2>\n<p class=\"sub\">Values at the grid points, and isolux lines. All "
      "drawings of a quantity use the same scale.</p>\n";
  if (a.has_electric)
    h += figure(scale_legend(scales.electric, "lx", full_width), "Electric light, maintained");
  if (a.has_daylight) h += figure(scale_legend(scales.daylight, "lx", full_width), "Daylight");
  if (a.has_factor) h += figure(scale_legend(scales.factor, "%", full_width), "Daylight factor");
  h += "<div class=\"surfaces\">\n";
  for (const SurfaceResult& s : a.surfaces) h += surface_section(s, scales);
  h += "</div>\n";
  const std::string parts = contributions_table(a);
  if (!parts.empty())
    h += "<h2>Contributions</h2>\n<p class=\"sub\">Mean maintained illuminance from each luminaire "
         "or group of luminaires alone, lx. The sum agrees with the mean for all luminaires "
         "together within the uncertainty.</p>\n" +
         parts;
  return h;
}

// Assigns a type to each luminaire: those that differ only in their place share one.
std::vector<size_t> types_of(const std::vector<PlacedLuminaire>& all, std::vector<size_t>& firsts) {
  const auto is_same = [](const PlacedLuminaire& a, const PlacedLuminaire& b) {
    return a.product == b.product && a.watts == b.watts &&
           std::abs(a.lumens - b.lumens) <= 0.005 * std::max(a.lumens, b.lumens);
  };
  std::vector<size_t> types;
  for (size_t i = 0; i < all.size(); ++i) {
    size_t t = 0;
    while (t < firsts.size() && !is_same(all[firsts[t]], all[i])) ++t;
    if (t == firsts.size()) firsts.push_back(i);
    types.push_back(t);
  }
  return types;
}

std::string type_block(const Assessment& a, size_t type, size_t first,
                       const std::vector<size_t>& types) {
  constexpr double side = 150;
  const PlacedLuminaire& l = a.luminaires[first];
  const auto count = std::count(types.begin(), types.end(), type);
  std::string text =
      fmt::format("<strong>Type {}</strong>: {}<br>{} × {} lm", char('A' + type % 26),
                  html_text(l.product), count, short_number(l.lumens));
  if (l.watts)
    text += fmt::format(", {} W", short_number(*l.watts));
  else
    text += ", power unknown";
  if (l.watts && *l.watts > 0)
    text += fmt::format("<br>{} lm/W", short_number(l.lumens / *l.watts));
  text += fmt::format("<br>{} cd maximum", short_number(l.curve.largest()));
  return "<div class=\"type\">" + polar_plot(l.curve, l.product, side) + "<p>" + text +
         "</p></div>\n";
}

std::string luminaires(const Report& r) {
  const Assessment& a = r.assessment;
  std::string h = "<h2>Luminaires and power</h2>\n";
  if (!a.luminaires.empty()) {
    constexpr size_t most = 12;
    std::vector<size_t> firsts;
    const std::vector<size_t> types = types_of(a.luminaires, firsts);
    h += "<p class=\"sub\">Polar curves: C0–C180 solid, C90–C270 dashed; the aim points "
         "down.</p>\n<div class=\"types\">\n";
    for (size_t t = 0; t < std::min(firsts.size(), most); ++t)
      h += type_block(a, t, firsts[t], types);
    h += "</div>\n" + luminaires_table(a, r.options.up, types);
  }
  h += daylight_table(a);
  return a.has_electric ? h + power_table(a.power) : h;
}

std::string glare_section(const Assessment& a) {
  if (a.glares.empty()) return {};
  bool is_large = false, is_small = false;
  for (const GlareResult& g : a.glares) {
    is_large = is_large || g.glare.is_large;
    for (const SeenLuminaire& l : g.glare.luminaires) is_small = is_small || l.is_small;
  }
  std::string h =
      "<h2>Glare</h2>\n<p class=\"sub\">UGR according to CIE 117: the worst observer of each "
      "surface, and the ratings for its other observers.</p>\n" +
      glare_table(a);
  if (is_large)
    h += "<p class=\"sub\">* A luminaire fills more than 0.1 sr of the view: the formula is not "
         "valid for it.</p>\n";
  if (is_small)
    h += "<p class=\"sub\">Luminaires with a visible area below 0.005 m² are rated as if they had "
         "that area (CIE 147).</p>\n";
  return h;
}

std::string cylinders(const Assessment& a) {
  if (a.cylinders.empty()) return {};
  return fmt::format(
             "<h2>Cylindrical illuminance</h2>\n<p class=\"sub\">Maintained, at eye height: the "
             "mean over {} vertical planes in all directions.</p>\n",
             cylinder_planes) +
         cylinder_table(a);
}

std::string picture_section(const std::vector<ReportPicture>& pictures) {
  if (pictures.empty()) return {};
  std::string h = "<h2>Pictures</h2>\n";
  for (const ReportPicture& p : pictures) {
    const auto image = [&](const std::vector<uint8_t>& png, const char* what) {
      return fmt::format("<img alt=\"{}\" src=\"data:image/png;base64,{}\">", what, base64(png));
    };
    const std::string camera = p.name.empty() ? "" : ", camera " + html_name(p.name);
    h += figure(image(p.seen, "the room as seen by the camera"),
                "The room as seen by the camera" + camera + ".", "picture") +
         figure(image(p.luminances, "luminances in false colours") +
                    factor_legend(p.scale.least, p.scale.largest, "cd/m²", full_width),
                fmt::format("Initial luminances{}; mean {} cd/m²{}.", camera, short_number(p.mean),
                            p.estimated_error > 0
                                ? fmt::format(", uncertainty of a pixel {:.1f} % of it",
                                              100 * p.estimated_error)
                                : ""),
                "picture");
  }
  return h;
}

std::string list_of(const std::vector<std::string>& items) {
  if (items.empty()) return {};
  std::string h = "<ul class=\"notes\">";
  for (const std::string& i : items) h += "<li>" + html_text(i) + "</li>";
  return h + "</ul>\n";
}

std::string appendix(const Report& r) {
  std::vector<std::string> notes = r.assessment.notes;
  for (const std::string& w : r.info.warnings) notes.push_back("warning: " + w);
  return "<h2>Appendix</h2>\n" + list_of(notes) +
         "<p class=\"sub\">Grids follow EN 12464-1. Floor area is the area within the walls; "
         "furniture counts as floor. ± is one standard error. A requirement is undecided if the "
         "value lies within two standard errors of it. The error of a mean is the mean of its "
         "points' errors, which is an upper bound. The minimum of noisy values lies below the "
         "minimum of exact values, by about the bias below; figures are not corrected for it. All "
         "points are in points.csv, all figures and observers in report.json.</p>\n" +
         bias_table(r.assessment) + info_tables(r.info);
}

}  // namespace

std::vector<std::string> report_plans(const Report& r) {
  constexpr double most_height = 470;  // px; leaves room for a summary of about ten rows on the
                                       // same page
  std::vector<std::string> drawings;
  for (const Storey& s : storeys_of(r.assessment, r.options.up))
    drawings.push_back(plan_plot(r.assessment, s, r.options, full_width, most_height));
  return drawings;
}

std::string report_page(const Report& r) {
  std::string h =
      "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; img-src data:; "
      "style-src 'unsafe-inline'\">\n<title>" +
      html_text(r.info.title) + "</title>\n<style>" + page_style + "</style></head><body>\n";
  h += head(r) + summary(r) + plans(r);
  if (r.other) h += comparison_section(r, *r.other);
  h += surfaces(r) + luminaires(r) + glare_section(r.assessment) + cylinders(r.assessment) +
       picture_section(r.pictures) + appendix(r);
  return h + "</body></html>\n";
}

}  // namespace troffer
