// Transforms and vectors of Mitsuba's XML files.
#pragma once

#include "base/transform.h"
#include "import/mitsuba/mitsuba_tree.h"

namespace troffer {

// x, y, z of a node, each `fallback`'s where it is not there; or three numbers (or one for all) as
// its value. InputError: text that is no number.
Vec3d vector_attribute(const MitsubaNode& node, const Vec3d& fallback);

// Of a <transform>: its children, the first one applied first. Of an <animation>: the first
// transform of it. InputError: what is no affine transform.
Affine transform_of(const MitsubaNode& node);

}  // namespace troffer
