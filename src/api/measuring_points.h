// Converts points of the public interface to those of the renderer. measure() and annual() use it.
#pragma once

#include <vector>

#include "render/measure.h"
#include "troffer/measure.h"

namespace troffer::api {

// Throws UsageError for points that are not finite, and for normals without length. owner: start of
// the message, such as "grid 'Desk', ".
std::vector<MeasuringPoint> measuring_points(const std::vector<MeasurePoint>& points,
                                             const std::string& owner = {});

}  // namespace troffer::api
