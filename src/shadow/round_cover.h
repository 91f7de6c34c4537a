// Removes from a mask the samples that round occluders hide: spheres, disks, and facets that enter
// a spherical source. coverage_mask.h covers all other facets.
// A sample in direction d is hidden by a ball, a disk or a planar section of a ball if d lies in a
// circular or elliptic cone. This is one inequality of second degree in d, and a linear one that
// selects the half of the cone. Over the samples both are polynomials in the canvas coordinates
// (k,j). Each row is therefore covered between two roots of a quadratic: exact, without
// tessellation.
// References: docs/method/certified-appendix.md, "Spheres and disks in the way".
#pragma once

#include "base/vec.h"
#include "shadow/coverage_mask.h"

namespace troffer {

// Rounding of distances to round bodies, relative to the largest coordinate: shaft_margin with a
// safety factor of three.
constexpr double round_margin = 2e-6;

// Clears the open samples that round occluders hide from world position x.
void cover(const MaskFrame& frame, const RoundList& round, const Vec3d& x, const Vec2& shift,
           CoverageMask& mask);

}  // namespace troffer
