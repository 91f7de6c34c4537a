// Portals: the rectangles that light of environment lights enters through (Light::portal). Used by
// importers and by the option that names a portal.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/vec.h"
#include "scene/scene.h"

namespace troffer {

// True if four corners, in order, form a rectangle within a thousandth.
bool is_rectangle(std::span<const Vec3d> corners);

// Corners of the rectangle that all meshes of that name fill in one plane. They run
// counterclockwise as seen from the front, which is the side that the light reaches. Nothing if
// they form no rectangle.
std::optional<std::vector<Vec3>> rectangle_of_meshes(const Scene& scene, const std::string& name);

}  // namespace troffer
