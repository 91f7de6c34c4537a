// Conservation of energy for one shot: what arrives is what was sent less what leaves the scene.
//
// Irradiance at a sample point is right for that place; times the element's area it is only a
// quadrature of what the element receives, off where elements are large for their distance to the
// shooter, and several times too much where surfaces lie in or nearly in one place, so that each of
// them receives what only the first one can. So the power that is passed on (not the irradiance
// that is stored) is corrected shot by shot: never more arrives than is sent, whatever the scene.
#pragma once

#include <span>

namespace troffer {

// Share of what a shooter sends that leaves the scene, and how sure that is.
struct OpenShare {
  double share = 0;
  double error = 0;  // three standard errors
};
// Of `rays` rays (spread like the light) the share `share` left. Scenes that no ray leaves anywhere
// are closed: there the share is known.
OpenShare open_share(double share, double rays, bool is_closed);

// What to count of a point's power: min(power, cap) * scale.
struct Closure {
  double cap = 0, scale = 1;
  double arrived = 0;  // the sum of what is counted
  float of(float power) const {
    return power > 0 ? float((double(power) < cap ? double(power) : cap) * scale) : 0.0f;
  }
};
// powers: what the points received, >= 0; `sum` of them. Up to `most_scale` all points are
// corrected alike; a larger excess is taken from those that got most, and what is missing beyond it
// stays missing.
constexpr double most_closure_scale = 0.3;
Closure close_shot(std::span<const float> powers, double sum, double sent, const OpenShare& open);

}  // namespace troffer
