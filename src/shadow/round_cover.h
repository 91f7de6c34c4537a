// Which samples of a mask what is no flat facet hides: spheres and disks, and facets that enter a
// sphere that is the source.
//
// A sample in the direction d from the receiver is hidden by a ball, a disk, or what a plane cuts
// from a ball, where d lies in a circular or elliptic cone: a form in d of the second degree is not
// positive, and one of the first tells which way the cone opens. Over the samples both are
// polynomials in the canvas coordinates (k,j), so that each row of bits is covered from one root of
// a quadratic to the other: exact, without tessellation, two numbers per row.
// References: docs/certified.md, "Spheres and disks in the way".
#pragma once

#include "base/vec.h"
#include "shadow/coverage_mask.h"

namespace troffer {

// Takes away the open samples that are hidden from world position x.
void cover(const MaskFrame& frame, const RoundList& round, const Vec3d& x, const Vec2& shift,
           CoverageMask& mask);

}  // namespace troffer
