// Whether measurements may be trusted as far as they say.
//
// What a method takes on trust (that light is even across a cell) no spread of its own samples
// tells. A few paths, which trust nothing, do; where they say otherwise, more paths take its place.
// Reference: [1] DerSimonian & Laird, "Meta-analysis in clinical trials", Controlled Clinical
//   Trials 7, 1986: the moments' estimate of what spreads measurements beyond their errors.
#pragma once

#include <vector>

#include "render/measure.h"

namespace troffer {

// By how much, relative to their light, points differ from what others say of the same points
// beyond what the standard errors of both let expect: [1], Eq. 8, about a mean that is known, 0;
// root mean square. 0 where chance alone would let them differ by as much in one list of a hundred.
double relative_bias(const std::vector<Measurement>& points,
                     const std::vector<Measurement>& others);

}  // namespace troffer
