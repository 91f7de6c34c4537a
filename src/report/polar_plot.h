// A luminaire's polar curve as a drawing.
#pragma once

#include <string>

#include "report/luminaire_parts.h"

namespace troffer {

// An SVG element `side` px wide and high: C0 to C180 solid, C90 to C270 dashed, the aim downwards,
// over rings of equal intensity. Empty where the luminaire is dark.
std::string polar_plot(const PolarCurve& curve, const std::string& title, double side);

}  // namespace troffer
