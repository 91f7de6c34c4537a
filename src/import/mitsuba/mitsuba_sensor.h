// Mitsuba's sensor plugins -> cameras.
//
// References: [1] W. Jakob et al., "Mitsuba 3 documentation: Sensors, Films".
#pragma once

#include "import/mitsuba/mitsuba_tree.h"
#include "scene/scene.h"

namespace troffer {

// tan of half the vertical field of view that a sensor or projector asks for by fov and fov_axis or
// by focal_length. aspect: width / height. InputError: values that cannot be.
double mitsuba_vertical_extent(const MitsubaNode& node, double aspect);

// Appends the camera of a <sensor> to the scene, its position counted from the scene's origin; of a
// batch, those of all sensors in it.
// Kinds other than perspective, thinlens and orthographic are shown as perspective, with a warning.
// InputError: angles, sizes and transforms that cannot be.
void add_mitsuba_camera(const MitsubaNode& node, const MitsubaTree& tree, Scene& scene);

}  // namespace troffer
