// Counts objects that stand on surfaces, as a sign of gravity: chairs, desks and cupboards stand on
// one floor, but few things touch one wall. scene/up_hints.h takes the axis with the most as
// vertical.
#pragma once

#include <array>
#include <cstddef>

#include "scene/scene.h"

namespace troffer {

// For up = +x, +y, +z: largest number of objects whose lowest points lie in one plane, each on a
// flat surface of another object. An object is a connected piece of a mesh, or a whole mesh in
// scenes of more than 300 000 triangles. Objects without volume (walls, panels) do not count.
std::array<size_t, 3> count_standing_objects(const Scene& scene);

}  // namespace troffer
