// Measures the light of a scene for a report: illuminance on grids, cylindrical illuminance and
// glare at eyes, luminaires and their power, and checks against requirements.
// `report` calls assess(); the tables, plots and data files of this folder show its result.
// Illuminance is in lx, lengths in m.
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

// Settings of assess().
struct AssessmentOptions {
  MeasureOptions measure;
  std::vector<Profile> profiles = standard_profiles();
  std::string profile = "office-writing";  // profile id of desks, work planes and surfaces that
                                           // name none
  std::vector<SurfaceRequest> surfaces;    // surfaces to assess; empty: find_surfaces()
  std::vector<Observer> observers;         // observers for glare; empty: observers_of()
  std::vector<PowerRequest> power;
  Vec3d up{0, 0, 1};                            // unit
  Vec3d north{0, 1, 0};                         // unit, level
  std::map<std::string, std::string> products;  // description of a product by its photometric file
  double maintenance = 0.8;                     // factor on electric light; not applied to UGR
  double work_plane = 0.75;                     // height above floors where there are no desks, m
  bool has_cylindrical = true, has_contributions = true;
  // Returns the scene lit by an overcast sky of 10 000 lx alone. Empty: no daylight factors. Called
  // only if openings show the sky, or if is_factor_forced.
  std::function<Scene()> overcast;
  bool is_factor_forced = false;
  std::vector<std::string> notes;  // remarks by the input files, for people
};

// Horizontal illuminance in the open that daylight factors refer to, lx.
constexpr double overcast_lx = 10'000;

// Measured light of one surface.
struct SurfaceResult {
  AssessedSurface surface;
  SurfaceGrid grid;
  // Values per point; empty if there is no such light. electric: maintained, lx; daylight: lx;
  // factor: daylight factor under an overcast sky, %.
  std::vector<Figure> electric, daylight, factor;
  std::vector<Figure> by_group;  // mean maintained illuminance by light group, lx; empty if not
                                 // asked for
};

// Cylindrical illuminance Ez at a place: the mean over vertical planes all around [EN 12464-1,
// 4.6.2]. Eh is the illuminance of the horizontal plane there. Both are maintained, in lx.
struct CylinderResult {
  size_t floor = 0;  // index into Assessment::floors
  Vec3d position;    // in the file's coordinates, m
  Figure cylindrical, horizontal;
};

struct GlareResult {
  size_t surface = 0;  // index into Assessment::surfaces; no_surface if the observer belongs to
                       // none
  Glare glare;
};
constexpr size_t no_surface = size_t(-1);

// Result of one requirement. open: the value lies within two standard errors of the requirement.
enum class Verdict : uint8_t { pass, fail, open };
struct Check {
  std::string subject;   // a surface's name
  std::string profile;   // id
  std::string quantity;  // "Ēm", "U0", "UGR", "Ēz"
  std::string unit;
  double required = 0;
  bool is_most = false;  // true if `required` is an upper limit
  Figure value;
  Verdict verdict = Verdict::open;
};
// Returns the verdict on a value. is_most: `required` is an upper limit.
Verdict verdict_of(const Figure& value, double required, bool is_most);

// Luminous flux and electric power of a scene's luminaires.
struct PowerResult {
  double lumens = 0;
  std::optional<double> watts;  // empty if the power of some luminaire is unknown
  double floor_area = 0;        // m²
  Figure task_mean;             // area-weighted mean illuminance of all surfaces but floors, lx
};

// Result of assess().
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
  bool is_complete = true;         // false if stopped: no part of the result may be used then
};

// Returns the light that requirements apply to: electric light if there is any, else daylight.
const std::vector<Figure>& assessed_light(const SurfaceResult& surface);

// Number of vertical planes that approximate cylindrical illuminance. For odd n, the share of a
// small distant source is accurate to 2 / (4 n² - 1), which is 0.6 % for 9.
constexpr int cylinder_planes = 9;

// Measures a scene. Throws UsageError for names, profiles or powers that do not exist, and for more
// than 100 000 points. progress gets the done share from 0 to 1; `stop` ends the work early.
Assessment assess(const Scene& scene, const AssessmentOptions& options,
                  const ProgressCallback& progress, const StopFlag& stop);

}  // namespace troffer
