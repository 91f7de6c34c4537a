// Rotates scenes for file formats in which y is up. Used by the glTF exporter, which reports the
// rotation.
#pragma once

#include <array>
#include <string>

#include "base/vec.h"

namespace troffer {

// Returns the shortest rotation from `up` to +y, as images of the axes. Exact for axes: z becomes
// y, y becomes -z, x stays.
std::array<Vec3d, 3> rotation_to_y(const Vec3& up);

// Returns "(x, y, z) becomes (x, z, -y)" for rotations that exchange axes; otherwise empty.
std::string describe_turn(const std::array<Vec3d, 3>& images);

}  // namespace troffer
