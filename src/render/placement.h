// Detection of misplaced points and luminaires: outside of a closed room, or inside a body. A list
// with z up for a scene with y up produces many. Used by the commands that read lists of points and
// of luminaires.
#pragma once

#include <string>
#include <vector>

#include "render/measure.h"

namespace troffer {

// Returns one sentence for each kind of misplacement that names the luminaires, or nothing. Reports
// lights outside of a closed room, and luminaires whose light is blocked where they hang.
std::vector<std::string> misplaced_luminaires(const PreparedScene& scene);

// The same for points, by numbers from 1: points outside of a closed room, and points inside a body
// that received no light (`result`).
std::vector<std::string> misplaced_points(const PreparedScene& scene,
                                          const std::vector<MeasuringPoint>& points,
                                          const MeasureResult& result);

}  // namespace troffer
