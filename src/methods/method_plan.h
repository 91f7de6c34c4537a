// Plan of a method: what it decides before it prepares anything. The decisions depend on the scene,
// the options and a few thousand test paths. Planning is the first of three steps: plan, prepare
// (cells, fits), integrate. Printed by --explain and written to --stats.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "certified/certified_direct.h"
#include "methods/path.h"
#include "methods/path_forecast.h"

namespace troffer {

struct MethodInput;

// Ways to compute the light of a picture or of measuring points.
enum class PlannedLight : uint8_t {
  path_tracing,   // by PathIntegrator
  cells,          // certified direct light, reflected light gathered from cells
  sensor_paths,   // certified direct light, reflected light by paths (measuring points)
  direct,         // direct light alone, with the same settings for all viewing rays
  staged_direct,  // direct light alone, with coarser settings for further viewing rays
  radiosity,      // reflected light from the radiosity solution (kj92)
};

// A decision in words: what was chosen for which part of the work, and why.
struct PlannedPart {
  std::string part, choice, reason;
};

struct MethodPlan {
  PlannedLight light = PlannedLight::path_tracing;
  std::vector<PlannedPart> parts;
  // Test of path tracing, where paths may replace cells.
  std::optional<PathForecast> forecast;
  // Lights that a forecast has learned; null: none has.
  std::shared_ptr<const LearnedLights> learned_lights;
  // True if paths that end at cells may replace gathers.
  bool may_end_paths_at_cells = false;

  // certified: settings of direct light at first and further viewing rays, and at cells.
  CertifiedSettings first{}, further{}, at_cells{};
  // Limit of the number of cells. Beyond it, paths replace cells if there is a forecast. Otherwise
  // make_integrator() returns null.
  double most_cells = std::numeric_limits<double>::infinity();
  // Budget for direct light at cells, in rays (costs.h).
  double rays_for_direct = std::numeric_limits<double>::infinity();

  // True if the picture is path traced because the forecast says that this costs less.
  bool is_by_forecast() const { return light == PlannedLight::path_tracing && forecast; }
};

// Returns the plan as lines of text, one per part: "part: choice (reason)".
std::string as_text(const MethodPlan& plan);

// Decides for `certified`. Traces test paths if paths may replace cells, and adds them to the
// counters of `in.cells`.
MethodPlan plan_certified(const MethodInput& in);

// Allowed error of a path-traced picture. Pictures by cells have about half the asked error, so
// path tracing gets a stricter target, too.
constexpr double error_by_paths(double asked) {
  return 0.75 * asked;
}
// Returns the limit of viewing rays per pixel of a path-traced picture. asked: the user's limit; 0
// if there is none.
int most_by_paths(int asked);
// Forecasts what the picture costs by paths with these options. learned: lights that an earlier
// forecast has learned; set if this one learns them.
PathForecast forecast(const MethodInput& in, const PathOptions& options,
                      std::shared_ptr<const LearnedLights>& learned);

// Returns the allowed error of direct light beyond the first surface: at cells, and at surfaces
// that are seen in gloss. It is at least 0.1, because errors of many cells average out and gloss
// carries only a part of the light.
double error_beyond_first(const MethodInput& in);
// Settings of direct light at cells of a picture, or of points.
CertifiedSettings settings_of_cells(const MethodInput& in);
// Settings of direct light for that error.
CertifiedSettings settings_beyond_first(const MethodInput& in);

}  // namespace troffer
