// Measurements as a CSV table, as the command measure and the viewer write it. Positions are in the
// file's coordinates, light is in W/m² and lx.
#pragma once

#include <string>
#include <vector>

#include "render/measure.h"

namespace troffer {

// Returns a header and one row per point: position, normal, irradiance (W/m²), illuminance and its
// standard error (lx). Stops at the end of the shorter list.
std::string measurements_csv(const std::vector<MeasuringPoint>& points,
                             const std::vector<Measurement>& values);
// The same, without points that were not measured.
std::string measurements_csv(const std::vector<MeasuringPoint>& points,
                             const MeasureResult& result);

}  // namespace troffer
