// A year of daylight at sensors: the whole calculation of `troffer annual`. It makes skies,
// reflected light (reflected_light.h) and the hours of every sensor, and hands the hours on as they
// come, so that memory does not grow with sensors × hours.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "annual/reflected_light.h"
#include "annual/year_figures.h"
#include "render/measuring_places.h"

namespace troffer {

struct AnnualOptions {
  int subdivision = 4;  // of the sky for direct light (ReinhartSky)
  double ground_reflectance = 0.2;
  std::string occupancy = "8-18";  // make_year_times()
  FigureSettings figures;
  int rays_of_sensor = 0;  // gather rays in all replicates together; 0: by the number of sensors
  uint64_t seed = 0;
  int threads = 0;
};

// Mean of all replicates in every hour (YearSkies) of one sensor, and its standard error, lx.
struct HoursOfSensor {
  std::vector<float> total, sun, error;
};

// Receives sensors in order, one at a time.
using TakeHours = std::function<void(size_t sensor, const HoursOfSensor& hours)>;

struct AnnualResult {
  YearSkies skies;
  YearTimes times;
  FigureTable figures;
  // Root mean square over sensors and hours of the standard error, relative to that of the
  // illuminance.
  double relative_error = 0;
  // The same over sensors and Tregenza's patches, for coefficients of reflected light.
  double relative_error_reflected = 0;
  size_t cells = 0, links = 0, sources = 0;  // of one replicate, at most
  bool is_complete = true;                   // false after a stop
};

// scene: without light sources that emit. Throws UsageError and InputError as make_year_times()
// does. take: may be empty.
AnnualResult compute_annual(const PreparedScene& scene, const std::vector<MeasuringPlace>& places,
                            const WeatherYear& year, const Compass& compass,
                            const AnnualOptions& options, const TakeHours& take,
                            const ProgressCallback& progress, const StopFlag& stop);

}  // namespace troffer
