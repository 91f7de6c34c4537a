// Photometric webs: intensity of a luminaire by direction, as measured. Plain data, filled in by
// importers and evaluated by light/web.h.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "base/vec.h"

namespace troffer {

// Axis of the luminaire that a web's angles count from. The axes: z to the nadir (or along the
// beam), x in the half-plane C0, y in C90, counterclockwise from above (from behind).
enum class WebPole : uint8_t {
  nadir,  // type C: heights from z, turns from x to y
  up,     // type A: heights from x, turns from z to -y
  right,  // type B: heights from -y, turns from z to x
};

// Radiant (or luminous) intensity by the angle from the pole and around it, linear in both.
struct LightWeb {
  std::string name;
  WebPole pole = WebPole::nadir;
  std::vector<float> vertical_angles_rad;    // from the pole, ascending in [0, pi], at least 2
  std::vector<float> horizontal_angles_rad;  // ascending over at most 2 pi, at least 2
  std::vector<float> intensities;            // [turn][height]; W/sr or cd; 0 beyond the angles
  // Luminous opening in the luminaire's axes: the outward normals of its faces times their areas
  // (m²), or the cross-section of a sphere (m²). All surfaces with this web together form it. No
  // faces and cross-section 0: a point.
  std::vector<Vec3> faces;
  float cross_section = 0;
};

// Axes that a web's angles count from, in the luminaire's axes: turns go from the first to the
// second, heights from the third.
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
