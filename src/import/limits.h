// How much is read of files in any format.
#pragma once

#include <cstdint>

namespace troffer {

constexpr uint64_t max_scene_triangles = 60'000'000;  // in one place of a scene or another
constexpr uint64_t least_shape_cost = 20;              // of a shape, in triangles
constexpr int max_picture_side = 65536;               // of a film, in pixels

}  // namespace troffer
