// annual() of the public interface.
#include "annual/annual.h"

#include <atomic>

#include "annual/annual_report.h"
#include "annual/path_scenes.h"
#include "api/measuring_points.h"
#include "api/scene_impl.h"
#include "api/script_words.h"
#include "api/values.h"
#include "api/watched.h"
#include "lighting/weather_year.h"
#include "scene/orientation.h"
#include "troffer/annual.h"

namespace troffer::api {

namespace {

constexpr int most_rays = 1 << 20, least_rays = 8;

troffer::AnnualOptions options_of(const AnnualOptions& o) {
  if (o.gather_rays != 0) (void)in_range(o.gather_rays, least_rays, most_rays, "gather_rays");
  troffer::AnnualOptions made;
  made.subdivision = int(in_range(o.subdivision, 1, 8, "subdivision"));
  made.ground_reflectance = in_range(o.ground, 0, 1, "ground");
  made.occupancy = o.occupancy;
  made.blinds = o.blinds;
  made.figures.da_lx = in_range(o.threshold, 1, 100000, "threshold");
  made.rays_of_sensor = o.gather_rays;
  made.seed = o.seed;
  made.threads = int(in_range(o.threads, 0, 1 << 16, "threads"));
  return made;
}

// Grids as given, or those of the scene's file.
std::vector<SensorGrid> grids_or_own(const std::vector<SensorGrid>& given,
                                     const troffer::Scene& scene) {
  if (!given.empty()) return given;
  if (scene.grids.empty()) throw UsageError("annual: the scene has no sensor grids: give some");
  std::vector<SensorGrid> grids;
  for (const troffer::SensorGrid& g : scene.grids) {
    SensorGrid& made = grids.emplace_back();
    made.name = g.name;
    for (size_t i = 0; i < g.positions.size(); ++i)
      made.points.push_back({point(g.positions[i]), point(Vec3d(g.directions[i]))});
  }
  return grids;
}

// Everything that a calculation reads.
struct YearInputs {
  std::vector<MeasuringPoint> points;  // sensors, then eyes
  std::vector<SensorSpan> spans;
  size_t sensors = 0;
  std::vector<MeasuringPoint> sunlit;
  SunlightDay day;
  WeatherYear year;
  Compass compass;
};

YearInputs inputs_of(const std::vector<SensorGrid>& grids, ScriptScene& script,
                     const std::string& weather, const AnnualOptions& o) {
  YearInputs in;
  for (const SensorGrid& g : grids) {
    if (g.points.empty()) throw UsageError("grid '" + g.name + "' has no points");
    const std::vector<MeasuringPoint> its = measuring_points(g.points, "grid '" + g.name + "', ");
    in.spans.push_back({in.points.size(), its.size()});
    in.points.insert(in.points.end(), its.begin(), its.end());
  }
  in.sensors = in.points.size();
  const std::vector<MeasuringPoint> eyes = measuring_points(o.eyes, "eyes, ");
  in.points.insert(in.points.end(), eyes.begin(), eyes.end());
  in.sunlit = measuring_points(o.sunlight, "sunlight, ");
  in.day = with_script_words([&] { return parse_sunlight_day(o.sunlight_day); });
  in.year = read_weather_year(weather);
  in.compass =
      make_compass(script.up(), in_range(o.north, -360, 360, "north"), is_mirrored(script.scene()));
  return in;
}

std::vector<LightPath> paths_of(const ScriptScene& script, const std::string& groups) {
  const troffer::Scene& shown = script.scene();
  if (script.is_changed() && has_groups_of_model(shown))
    throw UsageError(
        "annual: the window groups of a Honeybee model are read from its file, which does not have "
        "the changes of this scene");
  return annual_paths({shown.file, script.import_options()}, shown, groups);
}

void append(std::vector<float>& all, const std::vector<float>& hours) {
  all.insert(all.end(), hours.begin(), hours.end());
}

void add_metrics(const FigureTable& table, AnnualDaylight& out) {
  for (const FigureColumn& c : figure_columns()) {
    SensorMetric& m = out.metrics.emplace_back(SensorMetric{c.name, c.title, c.unit, {}, {}});
    for (size_t s = 0; s < table.sensors(); ++s) {
      const YearFigure f = table.of(s, c.figure);
      m.values.push_back(f.value);
      m.standard_errors.push_back(f.error);
    }
  }
}

AnnualGrid grid_of(const std::string& name, const SensorSpan& span, const GridResult& result) {
  AnnualGrid g{name, span.first, span.count, {}, {}};
  for (const GridFigure& f : result.figures)
    g.metrics.push_back({f.key, f.title, f.unit, f.figure.value, f.figure.error});
  for (const GridRequirement& r : result.requirements)
    g.requirements.push_back(
        {r.title, r.need, r.figure.value, r.figure.error, verdict_name(r.verdict)});
  return g;
}

void add_groups(const std::vector<LightPath>& paths, const StateSchedule& schedule,
                AnnualDaylight& out) {
  for (size_t p = 0; p < paths.size(); ++p) {
    if (paths[p].name == static_path) continue;
    WindowGroupYear& g = out.groups.emplace_back();
    g.name = paths[p].name;
    for (const PathState& s : paths[p].states) g.states.push_back(s.name);
    const std::span<const uint16_t> shown = schedule.of(p);
    g.shown.assign(shown.begin(), shown.end());
  }
}

void add_glare(const YearTimes& times, AnnualDaylight& out) {
  for (EyeGlare& e : out.eyes) {
    e.shares = shares_of_glare(e.dgp, times);
    e.level = glare_level({{}, {}, {}, e.shares});
  }
}

void add_sunlit(const YearInputs& in, const std::vector<LightPath>& paths, int threads,
                AnnualDaylight& out) {
  for (const double hours : sunlight_hours(paths, in.sunlit, in.year, in.compass, in.day, threads))
    out.sunlight.push_back({hours, sunlight_level(hours)});
}

void add_electric(const std::vector<ElectricLight>& lights, const std::vector<DimmedUse>& uses,
                  AnnualDaylight& out) {
  for (size_t g = 0; g < uses.size(); ++g) {
    const DimmedUse& u = uses[g];
    out.electric.push_back({u.name, lights[g].lx, lights[g].error, u.sensors, u.mean_lx,
                            u.occupied_hours, u.full_load_hours});
  }
}

// Completes `out`, which holds the hours already.
void finish(const AnnualResult& result, const YearInputs& in, const std::vector<LightPath>& paths,
            const std::vector<SensorGrid>& grids, AnnualDaylight& out) {
  for (const uint32_t step : result.skies.steps)
    out.hours.push_back(in.year.steps[step].hour_of_year);
  out.occupied = result.times.is_occupied;
  out.sensors = in.sensors;
  out.place = in.year.place;
  out.relative_error = result.relative_error;
  add_metrics(result.figures, out);
  for (size_t g = 0; g < grids.size(); ++g)
    out.grids.push_back(
        grid_of(grids[g].name, in.spans[g],
                grid_result(result.figures, in.spans[g].first, in.spans[g].count,
                            !result.times.mornings.empty(), has_several_states(paths))));
  add_groups(paths, result.schedule, out);
}

// Everything that work on another thread needs.
struct YearTask {
  const ScriptScene& script;
  const std::vector<SensorGrid>& grids;
  const YearInputs& in;
  const std::vector<ElectricGroup>& electric;
  double target_lx = 0;
  const std::string& groups;
  const troffer::AnnualOptions& options;
};

AnnualDaylight year_of(const YearTask& task, std::atomic<double>& fraction, StopFlag& stop) {
  const YearInputs& in = task.in;
  const troffer::AnnualOptions& o = task.options;
  AnnualDaylight out;
  const std::vector<LightPath> paths =
      with_script_words([&] { return paths_of(task.script, task.groups); });
  const std::span sensors = std::span(in.points).first(in.sensors);
  const std::vector<ElectricLight> lights =
      measure_electric(task.script.scene(), task.electric, {sensors.begin(), sensors.end()}, o.seed,
                       o.threads, stop);
  DimmingYear dimming(lights, task.target_lx);
  const auto take = [&](size_t point, const HoursOfSensor& h) {
    if (point >= in.sensors) {
      out.eyes.push_back({h.total, h.dgp, {}, {}});
      return;
    }
    append(out.total, h.total);
    append(out.standard_error, h.error);
    append(out.direct, h.sun);
    dimming.add(point, h.total);
  };
  const AnnualResult result = with_script_words([&] {
    return compute_annual(
        {paths, in.points, in.spans, in.year, in.compass, in.points.size() - in.sensors}, o, take,
        [&](double f) { fraction = f; }, stop);
  });
  if (!result.is_complete) out = AnnualDaylight{};
  out.is_complete = result.is_complete;
  if (!result.is_complete) return out;
  finish(result, in, paths, task.grids, out);
  add_glare(result.times, out);
  add_sunlit(in, paths, o.threads, out);
  add_electric(lights, dimming.use(result.times, in.year.steps_per_hour), out);
  return out;
}

}  // namespace

AnnualDaylight annual(Scene& scene, const std::string& weather,
                      const std::vector<SensorGrid>& grids, const AnnualOptions& options,
                      const Progress& progress) {
  ScriptScene& script = scene.impl().script;
  const troffer::AnnualOptions o = options_of(options);
  const std::vector<SensorGrid> used = grids_or_own(grids, script.scene());
  const YearInputs in = inputs_of(used, script, weather, options);
  const double target = in_range(options.electric_target, 1, 100000, "electric_target");
  const std::vector<ElectricGroup> electric =
      with_script_words([&] { return electric_groups(script.scene(), options.electric); });
  AnnualDaylight out;
  std::atomic<double> fraction{0};
  double shown = 0;
  const auto work = [&](StopFlag& stop) {
    out = year_of({script, used, in, electric, target, options.groups, o}, fraction, stop);
  };
  run_watched(work, [&](StopFlag& stop) {
    shown = std::max(shown, fraction.load());
    if (progress && !progress(shown)) stop = true;
  });
  return out;
}

}  // namespace troffer::api
