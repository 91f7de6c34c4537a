/// @file
/// Plain types that all headers share.
///
/// Lengths are metres and angles are degrees. Light is linear with Rec. 709 primaries. Emission is
/// in W/(m² sr), or in cd/m² where Scene::is_photometric().
#pragma once

#include <array>
#include <functional>

namespace troffer::api {

/// A place or a direction: x, y, z.
using Point = std::array<double, 3>;

/// Linear colour: red, green, blue.
using Color = std::array<float, 3>;

/// An affine transform, row by row: x' = m[0][0] x + m[0][1] y + m[0][2] z + m[0][3], and so on.
using Transform = std::array<std::array<double, 4>, 3>;

/// The transform that changes nothing.
inline constexpr Transform identity{{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}};

/// Receives the fraction of the work that is done, 0 to 1, never falling. It is called about twenty
/// times a second by the thread that called the library. It returns false to stop the work. What it
/// throws stops the work too and is thrown to the caller.
using Progress = std::function<bool(double fraction)>;

}  // namespace troffer::api
