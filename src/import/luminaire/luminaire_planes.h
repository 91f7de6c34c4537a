// Conversion of the measured planes of a photometric file to a photometric web, by the readers of
// LM-63 and EULUMDAT. It fills in the planes that symmetry omits. Angles are in degrees here and in
// radians in LightWeb; intensities are in cd.
#pragma once

#include <string>
#include <vector>

#include "base/log.h"
#include "import/luminaire/photometric_text.h"
#include "scene/light_web.h"

namespace troffer {

// Measured planes as in the file. Type C: heights are gamma angles, turns are C angles. Types A and
// B: heights are vertical angles, turns are horizontal angles from -90 to 90.
struct Planes {
  std::vector<double> vertical_angles_deg, horizontal_angles_deg;
  std::vector<double> candela;  // turns × heights, a plane after the other
};

// Fails, at the last item read from `text`, unless the angles ascend.
void check_ascending(const std::vector<double>& angles, const PhotometricText& text,
                     const char* name);
// Fails unless the angles ascend throughout or descend throughout.
void check_monotonic(const std::vector<double>& angles, const PhotometricText& text,
                     const char* name);

// Unfolds planes of type C to turns from 0 to 360. The range of the planes tells their symmetry: 0
// to 90 is a quarter; 0 to 180, 180 to 360, 90 to 270 and -90 to 90 are halves. Other planes may
// begin anywhere.
LightWeb unfold_planes(const Planes& planes, const std::string& name, WarningLog& warnings);

// Unfolds planes of type A (pole `up`) or B (pole `right`). Angles that begin at 0 describe both
// sides. A single horizontal angle describes a beam of rotational symmetry.
LightWeb unfold_beam(const Planes& planes, WebPole pole, const std::string& name,
                     WarningLog& warnings);

}  // namespace troffer
