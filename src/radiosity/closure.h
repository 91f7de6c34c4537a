// Energy conservation for one shot: the power that arrives is the power sent minus the power that
// leaves the scene. LightShots and the solver use it.
//
// The irradiance at a sample point is right for that point, but irradiance times element area is
// only a quadrature of the power received. It is inaccurate where elements are large relative to
// their distance from the shooter. It is several times too large where surfaces coincide or nearly
// coincide, because each of them receives what only the first one can. The power that is passed on
// is therefore corrected per shot, so that never more arrives than is sent. The stored irradiance
// is not corrected.
#pragma once

#include <span>

namespace troffer {

// Share of a shooter's power that leaves the scene, with its uncertainty.
struct OpenShare {
  double share = 0;
  double error = 0;  // three standard errors
};
// Returns the open share if the share `share` of `rays` rays, distributed like the light, left the
// scene. In a closed scene, which no ray leaves, the share is exactly 0.
OpenShare open_share(double share, double rays, bool is_closed);

// Correction of a point's power: min(power, cap) * scale.
struct Closure {
  double cap = 0, scale = 1;
  double arrived = 0;  // sum of the corrected powers
  float of(float power) const {
    return power > 0 ? float((double(power) < cap ? double(power) : cap) * scale) : 0.0f;
  }
};
// Computes the correction for `powers` (received by the points, >= 0) and their `sum`. Up to a
// relative error of `most_closure_scale` all points are scaled alike. A larger excess is taken from
// the points that received most. A larger deficit is corrected only up to that limit.
constexpr double most_closure_scale = 0.3;
Closure close_shot(std::span<const float> powers, double sum, double sent, const OpenShare& open);

}  // namespace troffer
