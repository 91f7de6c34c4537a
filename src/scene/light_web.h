// How a light shines by direction, as measured: plain data. Evaluated by light/web.h.
#pragma once

#include <string>
#include <vector>

namespace troffer {

// Radiant (or luminous) intensity at angles from the axis z and around it, linear in both between.
struct LightWeb {
  std::string name;
  std::vector<float> heights_rad;  // from +z, ascending within [0, pi], at least 2
  std::vector<float> turns_rad;    // from x towards y, ascending from 0 to 2 pi, at least 2
  std::vector<float> intensities;  // per turn, per height; W/sr or cd; 0 beyond the heights
};

}  // namespace troffer
