// Corrections of the angles in photometric files: ends shifted by rounding, and tables that omit a
// pole. The readers of LM-63 and EULUMDAT apply them before planes are unfolded. Angles are in
// degrees.
#pragma once

#include <string>
#include <vector>

#include "base/log.h"
#include "import/luminaire/luminaire_planes.h"

namespace troffer {

// Distance outside a format's range at which an angle is still accepted.
constexpr double angle_slack_deg = 1;

// Snaps the first and last of monotonic angles to a multiple of 90. They must be less than a degree
// away from it, and less than half of the adjacent step. LM-63 and EULUMDAT allow tables to end
// only there, and the ends tell the symmetry.
// Warns if an angle moves by more than a tenth of a degree; `what` names the angles.
void snap_ends(std::vector<double>& angles, const char* what, const std::string& name,
               WarningLog& warnings);

// Extends ascending vertical angles of type C to the poles (0, 90 or 180). A table that begins
// within 5 degrees, or half a step, of a pole continues there with its first value. One that ends
// within half a step of a pole continues with its last value.
// Larger gaps stay dark. Warns of extensions, and of gaps next to light.
void extend_to_poles(Planes& planes, const std::string& name, WarningLog& warnings);

// Extends ascending angles of types A and B to 0 if they begin within 5 degrees, or half a step,
// above 0. Such tables describe both sides of the beam.
void extend_to_beam_axis(Planes& planes, const std::string& name, WarningLog& warnings);

}  // namespace troffer
