// Certificates of spheres and disks in the way: what they surely hide nothing of, and what all of.
// References: docs/certified.md, "Spheres and disks in the way".
#pragma once

#include <cstdint>
#include <span>

#include "base/round_body.h"
#include "shadow/coverage_mask.h"
#include "shadow/shaft.h"

namespace troffer {

enum class RoundFlag : uint8_t { unknown, hides_nothing, hides_all };

// Of all of the cell that the frame lies over, from all receivers in the hull.
RoundFlag classify(const RoundBody& body, const MaskFrame& frame, const ReceiverHull& hull);

}  // namespace troffer
