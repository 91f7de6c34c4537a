// Transforms and vectors of Mitsuba's XML files. Used by the readers of values and textures. Angles
// in files are degrees.
#pragma once

#include "base/transform.h"
#include "import/mitsuba/mitsuba_tree.h"

namespace troffer {

// Returns x, y and z of a node, missing ones from `fallback`; or its value of three numbers, or one
// for all. Throws InputError for text that is not a number.
Vec3d vector_attribute(const MitsubaNode& node, const Vec3d& fallback);

// Returns the affine transform of a <transform>: its children, the first one applied first. Of an
// <animation> it returns the first transform. Throws InputError for anything that is not affine.
Affine transform_of(const MitsubaNode& node);

}  // namespace troffer
