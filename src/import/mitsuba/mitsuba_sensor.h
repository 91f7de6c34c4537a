// Converts Mitsuba's sensor and film plugins to cameras. Used by MitsubaReader; projector lights
// share the field of view.
//
// References: [1] W. Jakob et al., "Mitsuba 3 documentation: Sensors, Films".
#pragma once

#include "import/mitsuba/mitsuba_tree.h"
#include "scene/scene.h"

namespace troffer {

// Tangent of half the vertical field of view of a sensor or projector, from fov and fov_axis or
// from focal_length. `aspect` is width / height. Throws InputError for impossible values.
double mitsuba_vertical_extent(const MitsubaNode& node, double aspect);

// Appends the camera of a <sensor> to the scene, or those of all sensors in a batch. Positions are
// relative to the scene's origin. Types other than perspective, thinlens and orthographic become
// perspective cameras, with a warning. Throws InputError for impossible angles, sizes and
// transforms.
void add_mitsuba_camera(const MitsubaNode& node, const MitsubaTree& tree, Scene& scene);

}  // namespace troffer
