#include <doctest/doctest.h>

#include <cmath>

#include "scene/rotation_to_y.h"

using namespace troffer;

TEST_CASE(
    "rotations take up to y and keep lengths and handedness; rotations between axes are exact") {
  for (const Vec3 up : {Vec3{0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}, {1, 0, 0}, {3, -4, 12}}) {
    const auto turn = rotation_to_y(up);
    const Vec3d u = normalize(Vec3d(up));
    const Vec3d y = turn[0] * u.x + turn[1] * u.y + turn[2] * u.z;
    CHECK(length(y - Vec3d{0, 1, 0}) < 1e-12);
    CHECK(dot(cross(turn[0], turn[1]), turn[2]) == doctest::Approx(1));
    for (size_t i = 0; i < 3; ++i)
      for (size_t j = 0; j < 3; ++j)
        CHECK(std::abs(dot(turn[i], turn[j]) - (i == j ? 1 : 0)) < 1e-12);
  }
  CHECK(rotation_to_y({0, 0, 1})[2] == Vec3d{0, 1, 0});
  CHECK(describe_turn(rotation_to_y({0, 0, 1})) == "(x, y, z) becomes (x, z, -y)");
  CHECK(describe_turn(rotation_to_y({1, 1, 0})).empty());
}
