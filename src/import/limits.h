// Limits on the content of scene files of any format. The importers check them before they allocate
// memory, and report InputError.
#pragma once

#include <cstdint>

namespace troffer {

constexpr uint64_t max_scene_triangles = 60'000'000;  // stored; instances count once
constexpr uint64_t least_shape_cost = 20;             // cost of any shape or instance, in triangles
constexpr int max_picture_side = 65536;               // width or height of a film, pixels

}  // namespace troffer
