// Measured planes of a photometric file -> its web: what symmetry leaves out is filled in.
#pragma once

#include <string>
#include <vector>

#include "base/log.h"
#include "import/luminaire/photometric_text.h"
#include "scene/light_web.h"

namespace troffer {

// Planes as a file has them. Types A and B: heights are its vertical angles, turns its horizontal
// ones, from -90 to 90.
struct Planes {
  std::vector<double> heights_deg, turns_deg;
  std::vector<double> candela;  // per turn, per height
};

void check_ascending(const std::vector<double>& angles, const PhotometricText& text,
                     const char* name);
// Fails unless they ascend or descend throughout.
void check_monotonic(const std::vector<double>& angles, const PhotometricText& text,
                     const char* name);

// Of type C: whole turns, from 0 to 360, of planes that begin anywhere and end with their symmetry:
// 0 … 90 a quarter, 0 … 180, 180 … 360, 90 … 270 and -90 … 90 halves.
LightWeb unfold_planes(const Planes& planes, const std::string& name, WarningLog& warnings);

// Of type A (pole `up`) or B (`right`). Angles that begin at 0 stand for both sides, and a single
// horizontal angle for all directions about the beam.
LightWeb unfold_beam(const Planes& planes, WebPole pole, const std::string& name,
                     WarningLog& warnings);

}  // namespace troffer
