// The rectangle that a light from beyond a scene comes through alone (Light::portal).
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/vec.h"
#include "scene/scene.h"

namespace troffer {

// Whether four corners, in order around it, are those of a rectangle, within a thousandth.
bool is_rectangle(std::span<const Vec3d> corners);

// The corners of the rectangle that the meshes of a name fill, in one plane, counterclockwise seen
// from their front, which is where the light arrives; nothing where they do not.
std::optional<std::vector<Vec3>> rectangle_of_meshes(const Scene& scene, const std::string& name);

}  // namespace troffer
