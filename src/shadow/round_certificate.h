// Certificates for spheres and disks as occluders.
// References: docs/method/certified-appendix.md, "Spheres and disks in the way".
#pragma once

#include <cstdint>
#include <span>

#include "base/round_body.h"
#include "shadow/coverage_mask.h"
#include "shadow/shaft.h"

namespace troffer {

enum class RoundFlag : uint8_t { unknown, hides_nothing, hides_all };

// Returns what the body provably does to the frame's cell, for all receivers in the hull.
RoundFlag classify(const RoundBody& body, const MaskFrame& frame, const ReceiverHull& hull);

}  // namespace troffer
