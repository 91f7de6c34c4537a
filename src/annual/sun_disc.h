// Directions to the sun's disc, for rays that tell how much of it is in view. Sensors, eyes and
// cells use them.
#pragma once

#include <array>
#include <cstddef>

#include "base/random.h"
#include "base/vec.h"

namespace troffer {

// Returns a direction within the sun's disc around a unit direction.
Vec3 within_sun(const Vec3& to_sun, const Vec2& number);

// The disc is divided into two rings of four sectors. Of such divisions, edges of the disc pass
// this one unseen most seldom.
constexpr size_t sun_strata = 8;

// Returns a random direction in each stratum of the disc, beginning with a random one. All of them
// miss an edge only where it cuts off less than a stratum.
std::array<Vec3, sun_strata> over_sun(const Vec3& to_sun, Random& random);

// Returns directions to the disc's rim, evenly spaced, the first one at a random angle. Of the
// straight edges that cross the disc, all of them miss only those that cut off less than 1.3 %:
// (2 pi / n - sin(2 pi / n)) / 2 pi with n = 8 directions.
constexpr size_t rim_points = 8;
std::array<Vec3, rim_points> rim_of_sun(const Vec3& to_sun, Random& random);

}  // namespace troffer
