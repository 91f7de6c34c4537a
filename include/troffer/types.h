/// @file
/// Plain types that all public headers share.
///
/// Lengths are metres and angles are degrees. Light is linear with Rec. 709 primaries. Emission is
/// in W/(m² sr), or in cd/m² if Scene::is_photometric().
#pragma once

#include <array>
#include <functional>

namespace troffer::api {

/// A position or a direction: x, y, z.
using Point = std::array<double, 3>;

/// Linear colour: red, green, blue.
using Color = std::array<float, 3>;

/// An affine transform, row by row: x' = m[0][0] x + m[0][1] y + m[0][2] z + m[0][3], and so on.
using Transform = std::array<std::array<double, 4>, 3>;

/// The transform that changes nothing.
inline constexpr Transform identity{{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}};

/// A function that receives the fraction of the work that is done, 0 to 1, which never falls. The
/// thread that called the library calls it about twenty times a second. If it returns false, the
/// work stops. If it throws, the work stops and the caller receives the exception.
using Progress = std::function<bool(double fraction)>;

}  // namespace troffer::api
