#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "report/checks.h"
#include "report/html_text.h"
#include "report/report.h"

namespace troffer {

namespace {

using Json = nlohmann::ordered_json;

Json json_of(const Figure& f) {
  return {{"value", f.value}, {"standard_error", f.error}};
}

// Rounds metres and directions to six decimals, which removes float noise and negative zero.
double tidy(double v) {
  return std::round(v * 1e6) / 1e6 + 0.0;
}

Json json_of(const Vec3d& v) {
  return {tidy(v.x), tidy(v.y), tidy(v.z)};
}

Json json_of(const GridSummary& s) {
  if (!s.has_values) return nullptr;
  return {{"mean", json_of(s.mean)},
          {"minimum", json_of(s.least)},
          {"minimum_bias", s.least_bias},
          {"maximum", json_of(s.most)},
          {"uniformity", json_of(s.uniformity)}};
}

Json json_of(const SurfaceResult& s, const std::vector<ReportedLights>& groups) {
  const AssessedSurface& a = s.surface;
  Json j{{"name", a.name},
         {"kind", name_of(a.kind)},
         {"profile", a.profile},
         {"corner", json_of(a.corner)},
         {"along", json_of(a.along)},
         {"across", json_of(a.across)},
         {"width_m", tidy(a.width)},
         {"height_m", tidy(a.height)},
         {"area_m2", tidy(a.area)},
         {"above_floor_m", tidy(a.above_floor)},
         {"border_m", tidy(a.border)},
         {"grid",
          {{"columns", s.grid.shape.columns},
           {"rows", s.grid.shape.rows},
           {"cell_m", {tidy(s.grid.cell.x), tidy(s.grid.cell.y)}},
           {"points", s.grid.points.size()}}},
         {"electric_lx", json_of(summary_of(s.electric))},
         {"daylight_lx", json_of(summary_of(s.daylight))},
         {"daylight_factor_percent", json_of(summary_of(s.factor))}};
  j["contributions_lx"] = Json::array();
  for (size_t g = 0; g < s.by_group.size(); ++g)
    if (!groups[g].is_daylight)
      j["contributions_lx"].push_back({{"luminaires", groups[g].name},
                                       {"value", s.by_group[g].value},
                                       {"standard_error", s.by_group[g].error}});
  return j;
}

Json json_of(const Assessment& a, const GlareResult& g) {
  Json j{{"surface", g.surface == no_surface ? Json() : Json(a.surfaces[g.surface].surface.name)},
         {"eye", json_of(g.glare.observer.position)},
         {"direction", json_of(g.glare.observer.direction)},
         {"background_luminance_cd_m2", json_of(g.glare.background)},
         {"ugr", g.glare.is_defined ? json_of(g.glare.ugr) : Json()},
         {"has_large_source", g.glare.is_large}};
  j["luminaires"] = Json::array();
  for (const SeenLuminaire& l : g.glare.luminaires)
    j["luminaires"].push_back({{"name", l.name},
                               {"luminance_cd_m2", l.luminance},
                               {"solid_angle_sr", l.solid_angle},
                               {"position_index", l.position_index},
                               {"term", json_of(l.term)},
                               {"is_small", l.is_small}});
  return j;
}

const char* name_of(Verdict v) {
  return v == Verdict::pass ? "pass" : v == Verdict::fail ? "fail" : "open";
}

Json json_of(const Check& c, double samples) {
  const std::optional<double> needed = samples_to_decide(c, samples);
  return {{"subject", c.subject},
          {"profile", c.profile},
          {"quantity", c.quantity},
          {"unit", c.unit},
          {"required", c.required},
          {"is_most", c.is_most},
          {"value", json_of(c.value)},
          {"verdict", name_of(c.verdict)},
          {"samples_to_decide", needed ? Json(std::ceil(*needed)) : Json()}};
}

Json lights_json(const Assessment& a) {
  Json j = Json::array();
  for (const ReportedLights& g : a.groups)
    j.push_back({{"name", g.name},
                 {"lights", g.lights},
                 {"count", g.luminaires},
                 {"is_daylight", g.is_daylight},
                 {"lumens", g.lumens},
                 {"watts", g.watts ? Json(*g.watts) : Json()}});
  return j;
}

Json luminaires_json(const Assessment& a) {
  Json j = Json::array();
  for (const PlacedLuminaire& l : a.luminaires) {
    j.push_back({{"name", l.name},
                 {"product", l.product},
                 {"position", json_of(l.position)},
                 {"aim", length(l.aim) > 0 ? json_of(l.aim) : Json()},
                 {"lumens", l.lumens},
                 {"watts", l.watts ? Json(*l.watts) : Json()},
                 {"largest_candela", l.curve.largest()}});
  }
  return j;
}

Json power_json(const PowerResult& p) {
  Json j{{"lumens", p.lumens},
         {"watts", p.watts ? Json(*p.watts) : Json()},
         {"floor_area_m2", p.floor_area},
         {"task_mean_lx", json_of(p.task_mean)}};
  const bool is_known = p.watts && p.floor_area > 0;
  j["watts_per_m2"] = is_known ? Json(*p.watts / p.floor_area) : Json();
  j["watts_per_m2_per_100_lx"] =
      is_known && p.task_mean.value > 0
          ? json_of(ratio({*p.watts / p.floor_area * 100, 0}, p.task_mean))
          : Json();
  return j;
}

Json info_json(const ReportInfo& i) {
  Json j{{"title", i.title},
         {"date", i.date},
         {"scene", i.scene},
         {"version", i.version},
         {"command", i.command}};
  j["settings"] = Json::object();
  for (const auto& [name, value] : i.settings) j["settings"][name] = value;
  j["inputs"] = Json::array();
  for (const InputHash& h : i.inputs)
    j["inputs"].push_back({{"file", h.file}, {"bytes", h.bytes}, {"sha256", h.sha256}});
  j["warnings"] = i.warnings;
  return j;
}

}  // namespace

std::string report_json(const Report& report) {
  const Assessment& a = report.assessment;
  Json j;
  j["format"] = "troffer report 1";
  j["info"] = info_json(report.info);
  j["north"] = json_of(report.options.north);
  j["samples_per_point"] = report.options.measure.spp;
  j["maintenance_factor"] = report.options.maintenance;
  j["checks"] = Json::array();
  for (const Check& c : a.checks) j["checks"].push_back(json_of(c, report.options.measure.spp));
  j["surfaces"] = Json::array();
  for (const SurfaceResult& s : a.surfaces) j["surfaces"].push_back(json_of(s, a.groups));
  j["cylindrical"] = Json::array();
  for (const CylinderResult& c : a.cylinders)
    j["cylindrical"].push_back({{"floor", a.floors[c.floor].name},
                                {"position", json_of(c.position)},
                                {"cylindrical_lx", json_of(c.cylindrical)},
                                {"horizontal_lx", json_of(c.horizontal)},
                                {"modelling", json_of(ratio(c.cylindrical, c.horizontal))}});
  j["glare"] = Json::array();
  for (const GlareResult& g : a.glares) j["glare"].push_back(json_of(a, g));
  j["lights"] = lights_json(a);
  j["luminaires"] = luminaires_json(a);
  j["power"] = power_json(a.power);
  j["notes"] = a.notes;
  // Names may be invalid UTF-8.
  return j.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string report_points(const Report& report) {
  std::string csv =
      "surface,column,row,x,y,z,nx,ny,nz,electric_lx,electric_error,daylight_lx,daylight_error,"
      "daylight_factor_percent,daylight_factor_error\n";
  for (const SurfaceResult& s : report.assessment.surfaces) {
    const Vec3d n = s.surface.normal();
    const std::string name = csv_field(s.surface.name);
    for (size_t i = 0; i < s.grid.points.size(); ++i) {
      const GridPoint& p = s.grid.points[i];
      csv += fmt::format("{},{},{},{},{},{},{},{},{}", name, p.column, p.row, tidy(p.position.x),
                         tidy(p.position.y), tidy(p.position.z), tidy(n.x), tidy(n.y), tidy(n.z));
      for (const auto* values : {&s.electric, &s.daylight, &s.factor})
        csv += values->empty()
                   ? ",,"
                   : fmt::format(",{:.7g},{:.4g}", (*values)[i].value, (*values)[i].error);
      csv += "\n";
    }
  }
  return csv;
}

}  // namespace troffer
