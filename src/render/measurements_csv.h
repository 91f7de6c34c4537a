// Measured points as a table.
#pragma once

#include <string>
#include <vector>

#include "render/measure.h"

namespace troffer {

// A line of names, and one for each point: where it lies, its normal, irradiance (W/m²),
// illuminance and its standard error (lx). For the shorter of both lists.
std::string measurements_csv(const std::vector<MeasuringPoint>& points,
                             const std::vector<Measurement>& values);
// Points that were not measured are left out.
std::string measurements_csv(const std::vector<MeasuringPoint>& points,
                             const MeasureResult& result);

}  // namespace troffer
