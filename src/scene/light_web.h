// How a light shines by direction, as measured: plain data. Evaluated by light/web.h.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "base/vec.h"

namespace troffer {

// By which of a luminaire's own axes the angles of a web count. Those axes: z towards the nadir (or
// along the beam), x in the half-plane C0, y in C90, counterclockwise seen from above (from
// behind).
enum class WebPole : uint8_t {
  nadir,  // type C: heights from z, turns from x towards y
  up,     // type A: heights from x, turns from z towards -y
  right,  // type B: heights from -y, turns from z towards x
};

// Radiant (or luminous) intensity at angles from the pole and around it, linear in both between.
struct LightWeb {
  std::string name;
  WebPole pole = WebPole::nadir;
  std::vector<float> heights_rad;  // from the pole, ascending within [0, pi], at least 2
  std::vector<float> turns_rad;    // ascending over at most 2 pi, at least 2
  std::vector<float> intensities;  // per turn, per height; W/sr or cd; 0 beyond the angles
  // The luminous opening that surfaces with this web are parts of, in the luminaire's axes: outward
  // normals of its faces times their areas, m²; or the cross-section of a sphere, m². Both empty: a
  // point.
  std::vector<Vec3> faces;
  float cross_section = 0;
};

// Directions, in the luminaire's axes, from which the angles of a web count: turns go from the
// first towards the second, heights from the third.
inline std::array<Vec3, 3> axes_of(WebPole pole) {
  switch (pole) {
    case WebPole::nadir:
      break;
    case WebPole::up:
      return {Vec3{0, 0, 1}, Vec3{0, -1, 0}, Vec3{1, 0, 0}};
    case WebPole::right:
      return {Vec3{0, 0, 1}, Vec3{1, 0, 0}, Vec3{0, -1, 0}};
  }
  return {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}};
}

}  // namespace troffer
