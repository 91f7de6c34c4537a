#include <fmt/format.h>

#include <algorithm>

#include "report/grid_plot.h"
#include "report/html_text.h"
#include "report/page_tables.h"
#include "report/report.h"

namespace troffer {

namespace {

constexpr const char* style = R"(
:root{color-scheme:light}
body{font:15px/1.45 system-ui,"Segoe UI",Roboto,"DejaVu Sans",sans-serif;color:#1b1f24;background:#fff;
 max-width:60rem;margin:0 auto;padding:1.5rem}
h1{font-size:1.7rem;margin:0 0 .2rem}h2{font-size:1.25rem;margin:2.2rem 0 .6rem;padding-top:.4rem;
 border-top:2px solid #1b1f24}h3{font-size:1.05rem;margin:1.4rem 0 .3rem}
p{margin:.4rem 0 .8rem}.sub{color:#56606b}
.table{overflow-x:auto}table{border-collapse:collapse;margin:.4rem 0 1rem;font-size:.9rem}
th,td{text-align:left;padding:.25rem .7rem .25rem 0;border-bottom:1px solid #d5dae0;vertical-align:top}
th{font-weight:600;color:#56606b}td{overflow-wrap:anywhere}
.n{font-variant-numeric:tabular-nums;white-space:nowrap}
.sum td{font-weight:600}.worst td{background:#fff6dd}
.pass,.fail,.open{font-weight:600;padding:0 .4rem;border-radius:.2rem;white-space:nowrap}
.pass{background:#d9f0dd;color:#0c5a21}.fail{background:#fbdcd8;color:#8a1409}.open{background:#fdeec2;color:#6a4a00}
.result{font-size:1.05rem;margin:.8rem 0}
figure{margin:.6rem 0 1.2rem}figcaption{font-size:.85rem;color:#56606b}
svg{max-width:100%;height:auto}.pictures{display:flex;gap:.8rem;align-items:flex-start;flex-wrap:wrap}
.pictures img{width:23.5rem;max-width:100%;height:auto}.pictures svg{flex:none}
code{font-size:.82rem;overflow-wrap:anywhere}.notes li{margin:.15rem 0}
@page{size:A4;margin:16mm 14mm}
@media print{body{max-width:none;padding:0;font-size:10pt;-webkit-print-color-adjust:exact;
 print-color-adjust:exact}h2,h3,h2+p{break-after:avoid}
 section.surface,figure,tr{break-inside:avoid}.pictures{flex-wrap:nowrap}.pictures img{width:13rem}
 .table{overflow:visible}}
)";

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
  h += " · " + html_text(r.info.scene) + "</p>\n<p class=\"result\">";
  if (a.checks.empty())
    h += "No requirement applies.";
  else
    h += count_of(a, Verdict::pass, "requirements met") + count_of(a, Verdict::fail, "not met") +
         count_of(a, Verdict::open, "too near to tell");
  return h + "</p>\n";
}

std::string requirements(const Report& r) {
  const Assessment& a = r.assessment;
  std::string h = "<h2>Requirements</h2>\n<p>";
  if (a.has_electric)
    h += fmt::format(
        "Of electric light, maintained: initial light times a maintenance factor of {:.2f}; UGR of "
        "initial light.",
        r.options.maintenance);
  else
    h += "Of daylight: no luminaire shines.";
  return h + " ± is one standard error.</p>\n" + checks_table(a, r.options.profiles);
}

std::string facts_of(const AssessedSurface& s, const SurfaceGrid& g, const Profile* p) {
  std::string f =
      fmt::format("{}, {:.2f} × {:.2f} m, {:.2f} m²", name_of(s.kind), s.width, s.height, s.area);
  if (s.above_floor > 0) f += fmt::format(", {:.2f} m above the floor", s.above_floor);
  f += fmt::format("; {} points, cells of {:.2f} × {:.2f} m", g.points.size(), g.cell.x, g.cell.y);
  if (s.border > 0) f += fmt::format(", {:.2f} m off the rim", s.border);
  f += fmt::format("; x, y = 0 at ({:.2f}, {:.2f}, {:.2f})", s.corner.x + 0.0, s.corner.y + 0.0,
                   s.corner.z + 0.0);
  if (p == nullptr) return f;
  f += ". Task: " + html_text(p->name);
  if (p->colour_rendering > 0)
    f += fmt::format(", which asks for R<sub>a</sub> ≥ {} (not computed)", p->colour_rendering);
  return f;
}

std::string figure(const std::string& drawing, const std::string& caption) {
  return "<figure>" + drawing + "<figcaption>" + caption + "</figcaption></figure>\n";
}

std::string surface_section(const Report& r, const SurfaceResult& s) {
  std::string h = "<section class=\"surface\"><h3>" + html_text(s.surface.name) +
                  "</h3>\n<p class=\"sub\">" +
                  facts_of(s.surface, s.grid, find_profile(r.options.profiles, s.surface.profile)) +
                  ".</p>\n" + summary_table(s);
  if (!s.electric.empty())
    h += figure(grid_plot(s.surface, s.grid, s.electric, "lx"),
                "Electric light, maintained illuminance at the grid's points, and isolux lines.");
  if (!s.daylight.empty())
    h += figure(grid_plot(s.surface, s.grid, s.daylight, "lx"), "Daylight, illuminance.");
  if (!s.factor.empty())
    h += figure(grid_plot(s.surface, s.grid, s.factor, "%"),
                "Daylight factor under a CIE overcast sky.");
  return h + contributions_table(r.assessment, s) + "</section>\n";
}

std::string glare_section(const Assessment& a) {
  if (a.glares.empty()) return {};
  bool is_large = false, is_small = false;
  for (const GlareResult& g : a.glares) {
    is_large = is_large || g.glare.is_large;
    for (const SeenLuminaire& l : g.glare.luminaires) is_small = is_small || l.is_small;
  }
  std::string h =
      "<h2>Glare</h2>\n<p>UGR after CIE 117, per observer; the worst of each surface is marked. "
      "L<sub>b</sub> is the background luminance.</p>\n" +
      glare_table(a);
  if (is_large)
    h += "<p>* A luminaire takes more than 0.1 sr of the view: the formula does not hold for "
         "it.</p>\n";
  if (is_small)
    h += "<p>Luminaires of which less than 0.005 m² are seen glare as if they were that large (CIE "
         "147).</p>\n";
  return h;
}

std::string room_sections(const Report& r) {
  const Assessment& a = r.assessment;
  std::string h = glare_section(a);
  if (!a.cylinders.empty())
    h += fmt::format(
             "<h2>Cylindrical illuminance</h2>\n<p>Maintained, at eye height, the mean over {} "
             "vertical planes all around.</p>\n",
             cylinder_planes) +
         cylinder_table(a);
  h += "<h2>Luminaires and power</h2>\n" + luminaires_table(a);
  if (a.has_electric) h += power_table(a.power);
  return h;
}

std::string picture_section(const std::vector<ReportPicture>& pictures) {
  if (pictures.empty()) return {};
  std::string h = "<h2>Luminances</h2>\n";
  for (const ReportPicture& p : pictures) {
    const auto image = [&](const std::vector<uint8_t>& png, const char* what) {
      return fmt::format("<img alt=\"{}\" src=\"data:image/png;base64,{}\">", what, base64(png));
    };
    h += figure(
        "<div class=\"pictures\">" + image(p.luminances, "luminances as false colours") +
            factor_legend(p.scale.least, p.scale.largest, "cd/m²") +
            image(p.seen, "the room as it is seen") + "</div>",
        fmt::format("Initial luminances{}{}; mean {} cd/m²{}.", p.name.empty() ? "" : ", camera ",
                    html_text(p.name), short_number(p.mean),
                    p.told_error > 0 ? fmt::format(", standard error of a pixel {:.1f} % of that",
                                                   100 * p.told_error)
                                     : ""));
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
  return "<h2>Appendix</h2>\n<p>Grids after EN 12464-1. The error of a mean is the mean of its "
         "points' errors, an upper bound. The least of noisy values lies below the least of true "
         "ones: the "
         "bias of the least tells by how much, about. It is not taken off.</p>\n" +
         list_of(notes) + info_tables(r.info);
}

}  // namespace

std::string report_page(const Report& r) {
  std::string h =
      "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; img-src data:; "
      "style-src 'unsafe-inline'\">\n<title>" +
      html_text(r.info.title) + "</title>\n<style>" + style + "</style></head><body>\n" + head(r) +
      requirements(r) + "<h2>Surfaces</h2>\n";
  for (const SurfaceResult& s : r.assessment.surfaces) h += surface_section(r, s);
  return h + room_sections(r) + picture_section(r.pictures) + appendix(r) + "</body></html>\n";
}

}  // namespace troffer
