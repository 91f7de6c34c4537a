// Angles of photometric files as their formats mean them: ends that rounding has moved, and tables
// that leave out a pole. Used by the readers of LM-63 and EULUMDAT before planes are unfolded.
// Angles are in degrees.
#pragma once

#include <string>
#include <vector>

#include "base/log.h"
#include "import/luminaire/luminaire_planes.h"

namespace troffer {

// How far outside of a format's range an angle may be written.
constexpr double angle_slack_deg = 1;

// Moves the first and the last of monotonic angles to the multiple of 90 that they nearly are: less
// than a degree off, and less than half of the step beside them. LM-63 and EULUMDAT let tables end
// only there, and the ends tell the symmetry. Warns where an angle moves by more than a tenth of a
// degree; `what` names the angles.
void snap_ends(std::vector<double>& angles, const char* what, const std::string& name,
               WarningLog& warnings);

// Ascending vertical angles of type C reach the poles (0, 90 or 180): a table that begins up to 5
// degrees, or half of a step, from one goes on there with its first value, and one that ends up to
// half of a step before one with its last. Other gaps stay dark. Each is a warning.
void reach_poles(Planes& planes, const std::string& name, WarningLog& warnings);

// Ascending angles of types A and B that begin up to 5 degrees, or half of a step, above 0 begin at
// 0: they stand for both sides.
void reach_beam(Planes& planes, const std::string& name, WarningLog& warnings);

}  // namespace troffer
