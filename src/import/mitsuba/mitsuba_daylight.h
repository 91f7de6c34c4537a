// Mitsuba's emitters `sky`, `sun` and `sunsky` -> lights, by Preetham's model.
//
// References: [1] W. Jakob, "Mitsuba 0.6 Documentation", §8.8 (Emitters); [2] "Mitsuba 3
//   documentation: Emitters"; [3] Preetham, Shirley & Smits, "A Practical Analytic Model for
//   Daylight", SIGGRAPH 1999.
#pragma once

#include <functional>

#include "import/mitsuba/mitsuba_tree.h"
#include "scene/scene.h"

namespace troffer {

// White, with the luminance of a clear sky of that turbidity, and told of. `add` names what is made
// and puts it into the scene. InputError: parameters that cannot be used.
void add_mitsuba_daylight(const MitsubaNode& node, const MitsubaTree& tree, WarningLog& warnings,
                          const std::function<void(Light)>& add);

}  // namespace troffer
