// Points and luminaires that stand where they cannot be meant to: outside of a closed room, or
// within a body. A list with z up beside a scene with y up makes many of them. Used by the commands
// that take lists of points and of luminaires.
#pragma once

#include <string>
#include <vector>

#include "render/measure.h"

namespace troffer {

// One sentence for each kind of place, which names the luminaires; none where all is well. Lights
// outside of a closed room count, and measured luminaires whose light is hidden where they hang.
std::vector<std::string> misplaced_luminaires(const PreparedScene& scene);

// The same of points, by their numbers from 1: those outside of a closed room, and those that no
// light reached (`result`) because they lie within a body.
std::vector<std::string> misplaced_points(const PreparedScene& scene,
                                          const std::vector<MeasuringPoint>& points,
                                          const MeasureResult& result);

}  // namespace troffer
