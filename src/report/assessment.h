// The light of a scene as a report states it: measured on grids, at eyes, by luminaires.
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "render/measure.h"
#include "report/find_surfaces.h"
#include "report/glare.h"
#include "report/groups.h"
#include "report/luminaire_parts.h"
#include "report/profile.h"
#include "report/statistics.h"

namespace troffer {

struct AssessmentOptions {
  MeasureOptions measure;
  std::vector<Profile> profiles = standard_profiles();
  std::string profile = "office-writing";  // of desks, work planes and what names none
  std::vector<SurfaceRequest> surfaces;    // empty: found by themselves
  std::vector<Observer> observers;         // empty: found by themselves
  std::vector<PowerRequest> power;
  Vec3d up{0, 0, 1};                            // unit
  Vec3d north{0, 1, 0};                         // unit, level
  std::map<std::string, std::string> products;  // of photometric files: what they say of themselves
  double maintenance = 0.8;                     // factor on electric light, but in UGR
  double work_plane = 0.75;                     // m above floors, where there are no desks
  bool has_cylindrical = true, has_contributions = true;
  // The scene by an overcast sky of 10 000 lx alone; empty: no daylight factors. Asked for where
  // openings show the sky, or is_factor_forced.
  std::function<Scene()> overcast;
  bool is_factor_forced = false;
  std::vector<std::string> notes;  // on the files that said so, for people
};

// The illuminance of a horizontal plane in the open, by which daylight factors count, lx.
constexpr double overcast_lx = 10'000;

struct SurfaceResult {
  AssessedSurface surface;
  SurfaceGrid grid;
  // Per point; empty: there is no such light. Maintained electric light, and daylight, lx; the
  // share of an overcast sky's light, %.
  std::vector<Figure> electric, daylight, factor;
  std::vector<Figure> by_group;  // of the mean, lx maintained; per group, empty: not asked for
};

// Cylindrical illuminance at a place: the mean over vertical planes all around, Ez [EN 12464-1,
// 4.6.2], and beside it that of the horizontal plane, Eh, both maintained, lx.
struct CylinderResult {
  size_t floor = 0;  // of Assessment::floors
  Vec3d position;    // in the file's coordinates, m
  Figure cylindrical, horizontal;
};

struct GlareResult {
  size_t surface = 0;  // of Assessment::surfaces, that the observer belongs to; no_surface: none
  Glare glare;
};
constexpr size_t no_surface = size_t(-1);

// One requirement against what was found. open: within two standard errors of it.
enum class Verdict : uint8_t { pass, fail, open };
struct Check {
  std::string subject;   // a surface's name
  std::string profile;   // id
  std::string quantity;  // "Ēm", "U0", "UGR", "Ēz"
  std::string unit;
  double required = 0;
  bool is_most = false;  // the value must not be more
  Figure value;
  Verdict verdict = Verdict::open;
};
Verdict verdict_of(const Figure& value, double required, bool is_most);

struct PowerResult {
  double lumens = 0;
  std::optional<double> watts;  // none: of a luminaire it is not known
  double floor_area = 0;        // m²
  Figure task_mean;             // lx, of desks, work planes and what was named, by area
};

struct Assessment {
  std::vector<SurfaceResult> surfaces;
  std::vector<AssessedSurface> floors;
  std::vector<ReportedLights> groups;
  std::vector<PlacedLuminaire> luminaires;  // one by one
  std::vector<CylinderResult> cylinders;
  std::vector<GlareResult> glares;
  std::vector<Check> checks;
  PowerResult power;
  bool has_electric = false, has_daylight = false, has_factor = false;
  std::vector<std::string> notes;  // for people
  bool is_complete = true;         // false: stopped; nothing of it is to be used
};

// The light that requirements count for: electric where there is any, else daylight.
const std::vector<Figure>& assessed_light(const SurfaceResult& surface);

// Planes around the vertical by which cylindrical illuminance is a mean. Odd: a small source far
// off has its share within 2 / (4 n² - 1) then, .6 %.
constexpr int cylinder_planes = 9;

// UsageError for names, profiles or powers that do not exist, and for more than 100 000 points.
Assessment assess(const Scene& scene, const AssessmentOptions& options,
                  const ProgressCallback& progress, const StopFlag& stop);

}  // namespace troffer
