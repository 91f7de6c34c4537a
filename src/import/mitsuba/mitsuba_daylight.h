// Converts Mitsuba's emitters `sky`, `sun` and `sunsky` to lights by Preetham's model. Used by
// add_mitsuba_light.
//
// References: [1] W. Jakob, "Mitsuba 0.6 Documentation", §8.8 (Emitters); [2] "Mitsuba 3
//   documentation: Emitters"; [3] Preetham, Shirley & Smits, "A Practical Analytic Model for
//   Daylight", SIGGRAPH 1999.
#pragma once

#include <functional>

#include "import/mitsuba/mitsuba_tree.h"
#include "scene/scene.h"

namespace troffer {

// Makes a white sky and sun with the luminance of a clear sky of that turbidity, and adds a warning
// that says so. Calls `add` for each light, which names it and adds it to the scene. Throws
// InputError for unusable parameters.
void add_mitsuba_daylight(const MitsubaNode& node, const MitsubaTree& tree, WarningLog& warnings,
                          const std::function<void(Light)>& add);

}  // namespace troffer
