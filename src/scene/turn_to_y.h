// Turns scenes for formats in which y is up.
#pragma once

#include <array>
#include <string>

#include "base/vec.h"

namespace troffer {

// The shortest rotation that takes a direction to +y: images of the axes. Exact for axes: z becomes
// y, y becomes -z, x stays.
std::array<Vec3d, 3> turn_to_y(const Vec3& up);

// "(x, y, z) becomes (x, z, -y)" for turns that exchange axes; empty for others.
std::string describe_turn(const std::array<Vec3d, 3>& images);

}  // namespace troffer
