/// @file
/// Illuminance and irradiance at points.
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
  Point normal{0, 0, 1};  ///< the side that is lit; any length but zero
};

/// Result at one point.
struct Measurement {
  double illuminance = 0;     ///< lx
  double standard_error = 0;  ///< lx; illuminance ± 1.96 of these holds the true value in 95 of 100
  Color irradiance{};         ///< W/m² per channel, or lx where the scene is photometric
};

/// Measurements in the order of the points.
struct Measurements {
  std::vector<Measurement> values{};       ///< one per point
  bool is_complete = true;                 ///< false after a stop
  std::vector<bool> is_measured{};         ///< per point; false where a stop came before
  std::uint64_t shadow_rays = 0;           ///< visibility rays
  std::vector<std::size_t> in_surfaces{};  ///< points in a surface; measured just before its front
};

/// Measures the light that arrives at points.
/// @throws UsageError for points that are not finite, for normals without length, and for options
///   without meaning
/// @throws EnvironmentError where memory runs out
Measurements measure(Scene& scene, const std::vector<MeasurePoint>& points,
                     const LightOptions& options = {}, const Progress& progress = {});

}  // namespace troffer::api
