// From where a picture, or measuring points, will ask for light: what cells are made for.
#pragma once

#include <vector>

#include "gather/cell_builder.h"
#include "render/camera.h"

namespace troffer {

// Viewing rays all over the picture, the same for every crop of it.
CellPilot picture_pilot(const ViewingCamera& camera, const ImageSize& size, uint64_t seed);

// Places all over the surfaces of the scene, as many on every square metre of either side.
CellPilot surfaces_pilot(const PreparedScene& scene, uint64_t seed);

// Points are often given on the very surface they measure, rounded to a few digits: rays start
// some rounding errors of their coordinates off it, and never less than a hundredth of a millimetre
// (or a millionth of a scene smaller than ten metres).
float offset_of_point(const Vec3& position, const Box& scene);

}  // namespace troffer
