// Correction of standard errors for light that few of many samples find.
//
// Example: a fiftieth of a point's light arrives by one sample in ten thousand, from a small lamp
// by way of a glass ball. At some points no sample finds it, and the others differ little: the
// point is two per cent too dark, and its standard error does not show it. Other points of the list
// have found such samples and provide a better estimate of the variance. Reference:
// docs/method/measuring.md, "Rare light".
#pragma once

#include <cstddef>
#include <vector>

#include "render/point_plan.h"

namespace troffer {

// Raises the standard errors of the points `which`, if the sets of the list's points differ by few
// large values (high kurtosis). The new value tends to the usual error in the list for as many
// samples, absolute or relative to the point's light, whichever is less. Single points and lists
// with normally distributed sets keep their errors.
// Limit: the estimate assumes errors in proportion to 1/√n, but those of Sobol points fall faster.
// Points with few samples therefore tend to raise the errors of others too much.
void raise_errors_for_rare_light(std::vector<PointLight>& points, const std::vector<size_t>& which);

}  // namespace troffer
