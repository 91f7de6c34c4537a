// Draws a luminaire's polar intensity curve as SVG, for the list of luminaires of a report.
#pragma once

#include <string>

#include "report/luminaire_parts.h"

namespace troffer {

// Returns an SVG element, `side` px wide and high: C0-C180 solid, C90-C270 dashed, the aim
// downward, over rings of equal intensity. Empty if the luminaire is dark.
std::string polar_plot(const PolarCurve& curve, const std::string& title, double side);

}  // namespace troffer
