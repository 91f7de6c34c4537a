// Light that arrives by few samples of many: what their spread tells of errors, and what it does
// not.
//
// Where a fiftieth of a point's light comes by one sample in ten thousand (by way of a glass ball,
// from a small lamp), of some points none comes, and the samples that did come differ by little:
// the point is two per cent too dark, and its standard error says nothing of it. Other points of
// the list have met such samples, and tell. Reference: docs/measure.md, "Rare light".
#pragma once

#include <cstddef>
#include <vector>

#include "render/point_plan.h"

namespace troffer {

// Raises standard errors of `which` of a list's points where its points' sets of samples differ by
// few large values (kurtosis): towards what is usual in the list, for as many samples, of a point's
// own light or of the list's, whichever is less. (Errors of sets of Sobol points fall faster than
// their number grows, so that points with few samples raise others too far, if at all.) A single
// point keeps its own; so do all where sets are as if normally distributed.
void tell_rare_light(std::vector<PointLight>& points, const std::vector<size_t>& which);

}  // namespace troffer
