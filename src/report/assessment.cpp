#include "report/assessment.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "base/error.h"
#include "report/checks.h"
#include "report/eyes.h"

namespace troffer {

namespace {

constexpr size_t most_points = 100'000, most_groups = 12;

Figure figure_of(const Measurement& m) {
  return {m.illuminance_lx, m.standard_error};
}

// Points that are measured together.
struct PointList {
  std::vector<MeasuringPoint> points;
  void add(const Vec3d& position, const Vec3d& normal) {
    points.push_back({position, Vec3(normal)});
  }
};

// Divides the progress of an assessment into steps of equal share.
class Steps {
 public:
  Steps(size_t count, const ProgressCallback& progress) : count_(count), progress_(progress) {}
  ProgressCallback next() {
    const double first = double(done_++);
    return [this, first](double f) {
      if (progress_) progress_(std::min(1.0, (first + f) / double(count_)));
    };
  }

 private:
  size_t count_, done_ = 0;
  const ProgressCallback& progress_;
};

// State that all steps of an assessment share.
struct Work {
  const AssessmentOptions& options;
  const StopFlag& stop;
  Steps steps;
  std::vector<EyePlace> eyes = {};
  std::vector<PlacedObserver> observers = {};
};

// Returns the illuminance at each point of the list; empty if the measurement was stopped.
std::vector<Figure> figures_at(const PreparedScene& scene, const PointList& list,
                               const MeasureOptions& options, Work& work) {
  if (list.points.empty()) return {};
  const MeasureResult r = measure(scene, list.points, options, work.steps.next(), work.stop);
  std::vector<Figure> figures;
  if (!r.is_complete) return figures;
  for (const Measurement& m : r.values) figures.push_back(figure_of(m));
  return figures;
}

void add_grids(const Assessment& a, PointList& list) {
  for (const SurfaceResult& s : a.surfaces)
    for (const GridPoint& p : s.grid.points) list.add(p.position, s.surface.normal());
}

// Copies the figures of the points that add_grids() added, times a factor, to the surfaces.
void take_grids(const std::vector<Figure>& figures, double factor, Assessment& a,
                std::vector<Figure> SurfaceResult::*member) {
  size_t at = 0;
  for (SurfaceResult& s : a.surfaces)
    for (size_t i = 0; i < s.grid.points.size(); ++i)
      (s.*member).push_back(scaled(figures[at++], factor));
}

// Normals of the vertical planes at a place. Each place turns them by a golden-ratio step, so that
// places do not share directions.
std::vector<Vec3d> directions_around(const Vec3d& up, size_t place) {
  const Framed frame(up);
  constexpr double golden = 0.6180339887498949;
  std::vector<Vec3d> directions;
  for (int k = 0; k < cylinder_planes; ++k) {
    const double turn = 2 * pi * (k + std::fmod(golden * double(place), 1.0)) / cylinder_planes;
    directions.push_back(frame.tangent * std::cos(turn) + frame.bitangent * std::sin(turn));
  }
  return directions;
}

void add_eyes(const Work& work, PointList& list) {
  const Vec3d& up = work.options.up;
  for (size_t i = 0; i < work.eyes.size(); ++i) {
    list.add(work.eyes[i].position, up);
    for (const Vec3d& d : directions_around(up, i)) list.add(work.eyes[i].position, d);
  }
  for (const PlacedObserver& o : work.observers)
    list.add(o.observer.position, o.observer.direction);
}

size_t take_cylinders(const std::vector<Figure>& figures, size_t at, const Work& work,
                      Assessment& a) {
  const double factor = work.options.maintenance;
  for (const EyePlace& e : work.eyes) {
    CylinderResult c{e.floor, e.position, {}, scaled(figures[at], factor)};
    const auto first = figures.begin() + std::ptrdiff_t(at) + 1;
    c.cylindrical = scaled(mean_of({first, first + cylinder_planes}), factor);
    a.cylinders.push_back(c);
    at += 1 + cylinder_planes;
  }
  return at;
}

// Number of samples per luminaire that an observer sees. It grows with the samples per point, so
// that more of them decide about glare, too.
int glare_samples(int spp) {
  constexpr int least = 256, most = 1 << 16;
  return std::clamp(spp / 4, least, most);
}

// Computes the glare of every observer. all, direct: vertical illuminance at the observers' eyes,
// without the maintenance factor.
void take_glares(const PreparedScene& scene, const std::vector<Figure>& all,
                 const std::vector<Figure>& direct, const Work& work, Assessment& a) {
  for (size_t i = 0; i < work.observers.size(); ++i) {
    const Observer& o = work.observers[i].observer;
    const Figure indirect{std::max(0.0, all[i].value - direct[i].value),
                          std::hypot(all[i].error, direct[i].error)};
    a.glares.push_back({work.observers[i].surface,
                        glare_of(o, indirect,
                                 seen_luminaires(scene, o, work.options.up, i,
                                                 glare_samples(work.options.measure.spp)))});
  }
}

bool measure_electric(const PreparedScene& scene, Work& work, Assessment& a) {
  PointList list;
  add_grids(a, list);
  const size_t grids = list.points.size();
  add_eyes(work, list);
  const std::vector<Figure> figures = figures_at(scene, list, work.options.measure, work);
  if (figures.size() != list.points.size()) return false;
  take_grids(figures, work.options.maintenance, a, &SurfaceResult::electric);
  const size_t at = take_cylinders(figures, grids, work, a);
  PointList eyes;
  eyes.points.assign(list.points.begin() + std::ptrdiff_t(at), list.points.end());
  MeasureOptions direct = work.options.measure;
  direct.indirect = Indirect::none;
  if (direct.method == Method::path) direct.depth = 1;
  const std::vector<Figure> straight = figures_at(scene, eyes, direct, work);
  if (straight.size() != eyes.points.size()) return false;
  take_glares(scene, {figures.begin() + std::ptrdiff_t(at), figures.end()}, straight, work, a);
  return true;
}

bool measure_grids(const PreparedScene& scene, double factor, Work& work, Assessment& a,
                   std::vector<Figure> SurfaceResult::*member) {
  PointList list;
  add_grids(a, list);
  const std::vector<Figure> figures = figures_at(scene, list, work.options.measure, work);
  if (figures.size() != list.points.size()) return false;
  take_grids(figures, factor, a, member);
  return true;
}

// Measures each group of luminaires alone. With a single luminaire, its light is the whole electric
// light.
bool measure_groups(const Scene& scene, Work& work, Assessment& a) {
  const size_t luminaires = size_t(std::count_if(
      a.groups.begin(), a.groups.end(), [](const ReportedLights& g) { return !g.is_daylight; }));
  for (const ReportedLights& g : a.groups) {
    if (g.is_daylight) {
      for (SurfaceResult& s : a.surfaces) s.by_group.emplace_back();
      continue;
    }
    Assessment alone;
    for (const SurfaceResult& s : a.surfaces)
      alone.surfaces.push_back({s.surface, s.grid, {}, {}, {}, {}});
    if (luminaires > 1) {
      const PreparedScene lit(with_only_lights(scene, g.lights));
      if (!measure_grids(lit, work.options.maintenance, work, alone, &SurfaceResult::electric))
        return false;
    }
    for (size_t i = 0; i < a.surfaces.size(); ++i)
      a.surfaces[i].by_group.push_back(
          mean_of(luminaires > 1 ? alone.surfaces[i].electric : a.surfaces[i].electric));
  }
  return true;
}

// Removes points that lie under or inside an object: they say nothing about the surface's light.
void drop_covered(const PreparedScene& scene, const Vec3d& up, SurfaceResult& s,
                  std::vector<std::string>& notes) {
  constexpr double level = 0.9397;  // cosine of 20 degrees, the steepest floor
  if (dot(s.surface.normal(), up) < level) return;
  std::vector<Vec3d> points;
  for (const GridPoint& p : s.grid.points) points.push_back(p.position);
  const std::vector<uint8_t> is_covered = covered_points(scene, points, up);
  const auto open = std::count(is_covered.begin(), is_covered.end(), 0);
  if (open == std::ptrdiff_t(points.size())) return;
  notes.push_back(fmt::format("{}: {} of {} points lie under or within something{}", s.surface.name,
                              points.size() - size_t(open), points.size(),
                              open > 0 ? " and are left out" : "; they are measured anyway"));
  if (open == 0) return;
  size_t i = 0;
  std::erase_if(s.grid.points, [&](const GridPoint&) { return is_covered[i++] != 0; });
}

const Profile& profile_of(const AssessmentOptions& o, const AssessedSurface& s) {
  const Profile* p = find_profile(o.profiles, s.profile);
  if (p == nullptr)
    throw UsageError("there is no profile '" + s.profile + "', but " + profile_ids(o.profiles));
  return *p;
}

void place_surfaces(const PreparedScene& scene, const AssessmentOptions& o, Assessment& a) {
  FoundSurfaces found = o.surfaces.empty() ? find_surfaces(scene, o.up, o.profile, o.work_plane)
                                           : asked_surfaces(scene, o.up, o.surfaces, o.profile);
  a.floors = std::move(found.floors);
  a.notes = std::move(found.notes);
  size_t points = 0;
  for (AssessedSurface& s : found.surfaces) {
    profile_of(o, s);
    const GridShape shape = grid_shape(s.width, s.height);
    points += size_t(shape.columns) * size_t(shape.rows);
    if (points > most_points)
      throw UsageError(fmt::format("the grids have more than {} points", most_points));
    SurfaceResult r{std::move(s), {}, {}, {}, {}, {}};
    r.grid = grid_of(r.surface);
    if (r.surface.kind == SurfaceKind::floor) lift_onto_rugs(scene, o.up, r.grid.points);
    drop_covered(scene, o.up, r, a.notes);
    a.surfaces.push_back(std::move(r));
  }
  if (a.surfaces.empty())
    throw UsageError(
        "no desk and no floor was found: name what to assess by --surface or --surfaces");
}

void note_unrated(Assessment& a) {
  for (size_t i = 0; i < a.surfaces.size(); ++i) {
    bool sees_any = false;
    for (const GlareResult& g : a.glares)
      sees_any = sees_any || (g.surface == i && !g.glare.luminaires.empty());
    if (sees_any && worst_glare(a, i) == nullptr)
      a.notes.push_back(a.surfaces[i].surface.name +
                        ": glare could not be rated, because the background is too dark to measure "
                        "with this number of samples");
  }
}

void place_eyes(const PreparedScene& scene, const AssessmentOptions& o, const Assessment& a,
                Work& work) {
  const Profile* main = find_profile(o.profiles, o.profile);
  const double height = main != nullptr ? main->eye_height : 1.2;
  if (o.has_cylindrical) work.eyes = eye_places(scene, a.floors, o.up, height);
  if (!o.observers.empty()) {
    for (const Observer& e : o.observers) work.observers.push_back({no_surface, e});
    return;
  }
  std::vector<AssessedSurface> surfaces;
  std::vector<double> heights;
  for (const SurfaceResult& s : a.surfaces) {
    surfaces.push_back(s.surface);
    heights.push_back(profile_of(o, s.surface).eye_height);
  }
  work.observers = observers_of(scene, surfaces, o.up, heights);
}

bool wants_factor(const PreparedScene& scene, const AssessmentOptions& o, const Assessment& a) {
  if (!o.overcast) return false;
  if (o.is_factor_forced) return true;
  std::vector<Vec3d> points;
  for (const SurfaceResult& s : a.surfaces)
    for (const GridPoint& p : s.grid.points) points.push_back(p.position);
  return sees_beyond(scene, points, o.up);
}

// Measures all quantities, in the order of their use. Returns false if the work was stopped.
bool measure_all(const PreparedScene& whole, Work& work, Assessment& a) {
  const Scene& scene = whole.scene;
  const auto [daylight, luminaires] = daylight_and_luminaires(scene);
  // A scene that has only one kind of light needs no copy.
  std::unique_ptr<const PreparedScene> part;
  const auto lit_by = [&](const std::vector<std::string>& names, bool is_all) {
    part = is_all ? nullptr : std::make_unique<const PreparedScene>(with_only_lights(scene, names));
    return is_all ? &whole : part.get();
  };
  if (a.has_electric && !measure_electric(*lit_by(luminaires, daylight.empty()), work, a))
    return false;
  if (a.has_daylight &&
      !measure_grids(*lit_by(daylight, luminaires.empty()), 1, work, a, &SurfaceResult::daylight))
    return false;
  part = nullptr;
  if (a.has_electric && work.options.has_contributions && !measure_groups(scene, work, a))
    return false;
  if (!a.has_factor) return true;
  const PreparedScene overcast(work.options.overcast());
  return measure_grids(overcast, 100 / overcast_lx, work, a, &SurfaceResult::factor);
}

// Sums power, floor area and mean task illuminance. Sloping floors count by their area in plan,
// perpendicular to `up`.
PowerResult power_of(const Assessment& a, const Vec3d& up) {
  PowerResult p;
  p.watts = 0;
  for (const ReportedLights& g : a.groups) {
    if (g.is_daylight) continue;
    p.lumens += g.lumens;
    if (p.watts && g.watts)
      *p.watts += *g.watts;
    else
      p.watts.reset();
  }
  for (const AssessedSurface& f : a.floors) p.floor_area += f.area * dot(f.normal(), up);
  double area = 0;
  for (const SurfaceResult& s : a.surfaces) {
    if (s.surface.kind == SurfaceKind::floor || s.electric.empty()) continue;
    const Figure mean = scaled(mean_of(s.electric), s.surface.area);
    p.task_mean = {p.task_mean.value + mean.value, p.task_mean.error + mean.error};
    area += s.surface.area;
  }
  if (area > 0) p.task_mean = scaled(p.task_mean, 1 / area);
  return p;
}

}  // namespace

const std::vector<Figure>& assessed_light(const SurfaceResult& surface) {
  return surface.electric.empty() ? surface.daylight : surface.electric;
}

Assessment assess(const Scene& imported, const AssessmentOptions& options,
                  const ProgressCallback& progress, const StopFlag& stop) {
  const PreparedScene scene(with_daylight_apart(imported));
  Assessment a;
  a.groups = light_groups(scene.scene, options.power, most_groups);
  for (const ReportedLights& g : a.groups) (g.is_daylight ? a.has_daylight : a.has_electric) = true;
  place_surfaces(scene, options, a);
  a.has_factor = wants_factor(scene, options, a);
  const size_t groups = a.has_electric && options.has_contributions ? a.groups.size() : 0;
  Work work{options, stop, Steps(3 + groups, progress), {}, {}};
  if (a.has_electric) place_eyes(scene, options, a, work);
  a.luminaires = placed_luminaires(scene, options.power, options.products);
  a.is_complete = measure_all(scene, work, a);
  if (!a.is_complete) return a;
  a.power = power_of(a, options.up);
  note_unrated(a);
  a.checks = checks_of(a, options.profiles, options.profile);
  return a;
}

}  // namespace troffer
