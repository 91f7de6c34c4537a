#include "annual/annual_text.h"

#include <fmt/format.h>

#include <array>
#include <nlohmann/json.hpp>

#include "report/html_text.h"

namespace troffer {

namespace {

using Json = nlohmann::ordered_json;

constexpr std::array sensor_columns{
    FigureColumn{SensorFigure::da, "da", "%", "Daylight autonomy"},
    FigureColumn{SensorFigure::da_open, "da_open", "%", "Daylight autonomy, blinds open"},
    FigureColumn{SensorFigure::cda, "cda", "%", "Continuous daylight autonomy"},
    FigureColumn{SensorFigure::udi_fell_short, "udi_fell_short", "%", "UDI below 100 lx"},
    FigureColumn{SensorFigure::udi_supplementary, "udi_supplementary", "%", "UDI 100 to 300 lx"},
    FigureColumn{SensorFigure::udi_autonomous, "udi_autonomous", "%", "UDI 300 to 3000 lx"},
    FigureColumn{SensorFigure::udi_exceeded, "udi_exceeded", "%", "UDI above 3000 lx"},
    FigureColumn{SensorFigure::mean_lx, "mean_lx", "lx", "Mean illuminance in occupied hours"},
    FigureColumn{SensorFigure::exposure_klxh, "exposure_klxh", "klx h", "Annual light exposure"},
    FigureColumn{SensorFigure::sun_hours, "sun_hours", "h", "Occupied hours above 1000 lx of sun"},
    FigureColumn{SensorFigure::daylight_100, "daylight_100", "%", "Daylight hours from 100 lx on"},
    FigureColumn{SensorFigure::daylight_300, "daylight_300", "%", "Daylight hours from 300 lx on"},
    FigureColumn{SensorFigure::daylight_500, "daylight_500", "%", "Daylight hours from 500 lx on"},
    FigureColumn{SensorFigure::daylight_750, "daylight_750", "%", "Daylight hours from 750 lx on"},
    FigureColumn{SensorFigure::morning_lx, "morning_lx", "lx", "Clear equinox, 9 h"},
    FigureColumn{SensorFigure::afternoon_lx, "afternoon_lx", "lx", "Clear equinox, 15 h"},
};
static_assert(sensor_columns.size() == sensor_figures);

// Names in scenes may be invalid UTF-8, which JSON cannot hold.
std::string dump(const Json& json) {
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

Json grid_json(const AnnualGrid& g) {
  Json grid{{"name", g.name}, {"sensors", g.count}};
  for (const GridFigure& f : g.result.figures)
    grid["figures"][f.key] = {{"title", f.title},
                              {"unit", f.unit},
                              {"value", f.figure.value},
                              {"standard_error", f.figure.error}};
  grid["requirements"] = Json::array();
  for (const GridRequirement& r : g.result.requirements)
    grid["requirements"].push_back({{"title", r.title},
                                    {"need", r.need},
                                    {"value", r.figure.value},
                                    {"standard_error", r.figure.error},
                                    {"verdict", verdict_name(r.verdict)}});
  return grid;
}

}  // namespace

const char* verdict_name(YearVerdict v) {
  switch (v) {
    case YearVerdict::met:
      return "met";
    case YearVerdict::not_met:
      return "not met";
    case YearVerdict::undecided:
      return "undecided";
  }
  return "";
}

std::span<const FigureColumn> figure_columns() {
  return sensor_columns;
}

std::vector<double> hours_in_states(const AnnualReport& r, size_t path) {
  std::vector<double> hours(r.paths[path].states.size(), 0);
  const std::span<const uint16_t> states = r.result.schedule.of(path);
  for (size_t h = 0; h < states.size(); ++h)
    if (r.result.times.is_occupied[h] != 0) hours[states[h]] += 1.0 / r.year.steps_per_hour;
  return hours;
}

namespace {

Json point_json(const MeasuringPoint& p) {
  return {{"x", p.position.x}, {"y", p.position.y}, {"z", p.position.z}};
}

void add_extras(const AnnualExtras& extras, Json& json) {
  for (const EyeYear& e : extras.eyes) {
    Json eye = point_json(e.eye);
    eye["direction"] = {e.eye.normal.x, e.eye.normal.y, e.eye.normal.z};
    for (size_t k = 0; k < glare_limits.size(); ++k)
      eye["share_of_occupied_hours"][fmt::format("dgp_above_{:.2f}", glare_limits[k].dgp)] =
          e.shares[k];
    eye["protection_from_glare"] = glare_level(e);
    json["eyes"].push_back(std::move(eye));
  }
  for (const SunlitPoint& p : extras.sunlight) {
    Json point = point_json(p.point);
    point["hours"] = p.hours;
    point["level"] = sunlight_level(p.hours);
    json["sunlight"].push_back(std::move(point));
  }
  for (const DimmedUse& u : extras.electric)
    json["electric"].push_back({{"group", u.name},
                                {"sensors", u.sensors},
                                {"mean_lx", u.mean_lx},
                                {"target_lx", extras.electric_target_lx},
                                {"occupied_hours", u.occupied_hours},
                                {"full_load_hours", u.full_load_hours}});
}

}  // namespace

std::string annual_json(const AnnualReport& r) {
  const AnnualResult& result = r.result;
  Json json{{"program", "troffer"},
            {"version", r.version},
            {"command", r.command},
            {"scene", r.scene},
            {"warnings", r.warnings}};
  json["weather"] = {{"file", r.weather_file},
                     {"place", r.year.place},
                     {"latitude_deg", r.year.latitude_deg},
                     {"longitude_deg", r.year.longitude_deg},
                     {"zone_hours", r.year.zone_hours},
                     {"steps", r.year.steps.size()},
                     {"steps_per_hour", r.year.steps_per_hour},
                     {"steps_with_sun_up", result.skies.hours()},
                     {"steps_filled", r.year.filled}};
  json["settings"] = {{"occupancy", r.occupancy},
                      {"occupied_steps", result.times.occupied},
                      {"daylight_steps", result.times.daylight},
                      {"blinds", r.blinds},
                      {"da_lx", r.da_lx},
                      {"north_deg", r.north_deg},
                      {"subdivision", r.subdivision}};
  json["calculation"] = {{"replicates", replicate_count},
                         {"cells", result.cells},
                         {"links", result.links},
                         {"sources", result.sources},
                         {"relative_error_of_hours", result.relative_error},
                         {"relative_error_of_reflected", result.relative_error_reflected}};
  json["window_groups"] = Json::array();
  for (size_t p = 0; p < r.paths.size(); ++p) {
    if (r.paths[p].name == static_path) continue;
    Json group{{"name", r.paths[p].name}, {"states", Json::array()}};
    const std::vector<double> hours = hours_in_states(r, p);
    for (size_t s = 0; s < hours.size(); ++s)
      group["states"].push_back(
          {{"name", r.paths[p].states[s].name}, {"occupied_hours_with_daylight", hours[s]}});
    json["window_groups"].push_back(std::move(group));
  }
  json["grids"] = Json::array();
  for (const AnnualGrid& g : r.grids) json["grids"].push_back(grid_json(g));
  add_extras(r.extras, json);
  return dump(json);
}

std::string annual_metrics(const AnnualReport& r) {
  std::string out = "grid,x,y,z,nx,ny,nz";
  for (const FigureColumn& c : sensor_columns) out += fmt::format(",{0},{0}_error", c.name);
  out += "\n";
  for (const AnnualGrid& g : r.grids)
    for (size_t s = g.first; s < g.first + g.count; ++s) {
      const MeasuringPoint& p = r.points[s];
      out +=
          fmt::format("{},{:.9g},{:.9g},{:.9g},{:.6g},{:.6g},{:.6g}", csv_field(g.name),
                      p.position.x, p.position.y, p.position.z, p.normal.x, p.normal.y, p.normal.z);
      for (const FigureColumn& c : sensor_columns) {
        const YearFigure f = r.result.figures.of(s, c.figure);
        out += fmt::format(",{:.6g},{:.3g}", f.value, f.error);
      }
      out += "\n";
    }
  return out;
}

}  // namespace troffer
