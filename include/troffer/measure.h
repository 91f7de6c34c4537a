/// @file
/// Measures illuminance and irradiance at points.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "troffer/render.h"
#include "troffer/scene.h"

namespace troffer::api {

/// A point to measure at.
struct MeasurePoint {
  Point position{};       ///< metres
  Point normal{0, 0, 1};  ///< of the side that receives light; of any length above zero
};

/// Result at one point.
struct Measurement {
  double illuminance = 0;     ///< lx
  double standard_error = 0;  ///< lx; ± 1.96 standard errors is a 95 % confidence interval
  Color irradiance{};         ///< W/m² per channel, or lx if the scene is photometric
};

/// Measurements in the order of the points.
struct Measurements {
  std::vector<Measurement> values{};       ///< one per point
  bool is_complete = true;                 ///< false after a stop
  std::vector<bool> is_measured{};         ///< per point; false if the work stopped before it
  std::uint64_t shadow_rays = 0;           ///< visibility rays
  std::vector<std::size_t> in_surfaces{};  ///< points on a surface, measured just in front of it
};

/// Measures the light that arrives at points. Equal options and seed give equal results for any
/// number of threads.
/// @throws UsageError for points that are not finite, for normals without length, and for options
///   without meaning
/// @throws EnvironmentError if memory runs out
Measurements measure(Scene& scene, const std::vector<MeasurePoint>& points,
                     const LightOptions& options = {}, const Progress& progress = {});

}  // namespace troffer::api
