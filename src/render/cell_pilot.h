// Pilot samples for cache cells: the rays or places from which a picture or measuring points will
// ask for light. CellBuilder makes cells for what they see.
#pragma once

#include <vector>

#include "gather/cell_builder.h"
#include "render/camera.h"

namespace troffer {

// Returns viewing rays spread over the whole picture; the same for every crop of it.
CellPilot picture_pilot(const ViewingCamera& camera, const ImageSize& size, uint64_t seed);

// Returns places on both sides of all surfaces of the scene, with uniform density per area.
CellPilot surfaces_pilot(const PreparedScene& scene, uint64_t seed);

// Returns the distance from a measuring point at which its rays start, metres. Such points often
// lie on the surface that they measure, rounded to a few digits. The offset covers some rounding
// errors of the coordinates. It is at least .01 mm, or a millionth of the diagonal in scenes under
// 10 m.
float offset_of_point(const Vec3& position, const Box& scene);

}  // namespace troffer
