// A year of daylight at sensors: the whole calculation of `troffer annual`. It makes skies,
// reflected light (reflected_light.h), the operation of blinds (blinds.h) and the hours of every
// sensor, and hands the hours on as they come, so that memory does not grow with sensors × hours.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "annual/light_paths.h"
#include "annual/reflected_light.h"
#include "annual/reflected_store.h"
#include "annual/year_figures.h"
#include "render/measuring_places.h"

namespace troffer {

struct AnnualOptions {
  int subdivision = 4;  // of the sky for direct light (ReinhartSky)
  double ground_reflectance = 0.2;
  std::string occupancy = "8-18";  // make_year_times()
  // Operation of window groups: "lm-83", "open" (state 0 always), or the name of a table
  // (blinds.h).
  std::string blinds = "lm-83";
  FigureSettings figures;
  int rays_of_sensor = 0;  // gather rays in all replicates together; 0: by the number of sensors
  uint64_t seed = 0;
  int threads = 0;
};

// Scenes and sensors of a calculation.
struct AnnualRequest {
  const std::vector<LightPath>& paths;  // at least one, each with at least one state
  const std::vector<MeasuringPoint>& points;
  std::vector<SensorSpan> grids;  // for the operation of blinds
  const WeatherYear& year;
  const Compass& compass;
  size_t eyes = 0;  // number of eyes: the last points, whose normals are lines of sight
  ReflectedStore* store = nullptr;  // of finished reflected light; may be null
};

// Illuminance by way of one path in one state, lx per hour.
struct HoursOfState {
  std::vector<float> total, sun;
};

// One sensor in every hour (YearSkies): means of all replicates, lx.
struct HoursOfSensor {
  std::vector<float> total, error;   // blinds as operated, and its standard error
  std::vector<float> sun;            // straight from the sun, blinds open
  std::vector<HoursOfState> states;  // all states of the first path, then of the next
  std::vector<float> dgp;            // of an eye, blinds as operated; empty for other sensors
};

// Receives sensors in order, one at a time.
using TakeHours = std::function<void(size_t sensor, const HoursOfSensor& hours)>;

struct AnnualResult {
  YearSkies skies;
  YearTimes times;
  StateSchedule schedule;
  FigureTable figures;
  // Root mean square over sensors and hours of the standard error, relative to that of the
  // illuminance.
  double relative_error = 0;
  // The same over sensors, states and patches (YearSkies::coarse), for coefficients of reflected
  // light.
  double relative_error_reflected = 0;
  size_t cells = 0, links = 0, sources = 0;  // of the replicate that has most of them
  bool is_complete = true;                   // false after a stop
};

// Throws UsageError and InputError as make_year_times() and read_state_schedule() do. take: may be
// empty.
AnnualResult compute_annual(const AnnualRequest& request, const AnnualOptions& options,
                            const TakeHours& take, const ProgressCallback& progress,
                            const StopFlag& stop);

// Computes the own items of AnnualRequest::store (reflected_store.h) and keeps them there. Returns
// false after a stop.
bool compute_reflected_share(const AnnualRequest& request, const AnnualOptions& options,
                             const ProgressCallback& progress, const StopFlag& stop);

// Returns the key of AnnualRequest::store.
PictureKey key_of_store(const std::string& program, const AnnualRequest& request,
                        const AnnualOptions& options);

// True if blinds can move: a path has several states.
bool has_several_states(const std::vector<LightPath>& paths);

}  // namespace troffer
