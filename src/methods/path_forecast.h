// Forecast of what a picture costs by path tracing, from a few thousand test paths. The default
// method compares it with the least cost of a picture by cells (method_plan.cpp;
// docs/method/cells-appendix.md, "Paths").
//
// Cost is counted in rays, never in seconds. The choice is therefore the same on every machine, for
// any number of threads and for every crop of the picture.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>

#include "gather/gather_records.h"
#include "transport/costs.h"
#include "transport/integrator.h"
#include "transport/prepared_scene.h"

namespace troffer {

struct PathForecast {
  double viewing_rays = 0;  // mean per pixel for the asked error
  double rays = 0;          // rays of all kinds, for the whole picture
  double evenness = 0;      // of a pixel's paths (PixelSampling::evenness)
  double proportion = 0;    // PixelSampling::proportion
  double typical = 0;       // usual luminance of the picture (allowed_error.h)
  LightSampling lights;     // that costs least
  // Budget for making cells, in rays: `rays` minus the least cost of all other work of a picture by
  // cells. Negative: paths cost less even if cells are free.
  double rays_for_cells = 0;
  // True if pixels reach the asked error with at most so many viewing rays. Near the limit of the
  // mean, many pixels would stop before.
  bool is_within(int most) const { return 4 * viewing_rays <= most; }
};

// Returns the integrator whose viewing rays are tested, with this way of sampling lights.
using PathsToTest = std::function<std::unique_ptr<Integrator>(const LightSampling& lights)>;
// Returns learned lights. budget: cost of the work (costs.h). Adds its rays to `counters`.
using LightsToLearn =
    std::function<std::shared_ptr<const LearnedLights>(double budget, Counters& counters)>;

// Forecasts the cost of a picture with the way of sampling lights that costs least. learn: null if
// lights cannot be learned. error: allowed in a pixel (allowed_error()). most: limit of viewing
// rays per pixel. Adds the rays that it traces to `counters`.
PathForecast forecast_paths(const PathsToTest& paths, const LightsToLearn& learn,
                            const PictureView& view, double error, int most, uint64_t seed,
                            Counters& counters);

// Variance and cost of a path.
struct PathTest {
  double variance = 0, cost = 0;
};
// Both by judgement: four is far from one, and eight was the largest number chosen in public scenes
// (docs/log/results.md).
constexpr uint32_t few_light_samples = 4, most_light_samples = 16;
// Returns the power of two light samples at first hits, up to most_light_samples, with the least
// variance × cost of a path. The variance is one part that they share and a rest, the cost grows
// evenly with them: a path with one light sample and one with few_light_samples show both.
uint32_t cheapest_light_samples(const PathTest& one, const PathTest& few);

// Returns how the pixels of a picture by paths are to be sampled.
PixelSampling sampling_by_paths(const PathForecast& forecast, double error, int most);

// Least cost of making one cell, in rays of paths (costs.h): it casts about 24 rays.
constexpr double rays_of_cell = 24 * (1 + cost_of_cell_ray);

}  // namespace troffer
