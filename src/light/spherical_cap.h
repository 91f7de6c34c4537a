// Uniform sampling of the cone of directions to a sphere from outside, with density and inverse.
// References: [1] Pharr, Jakob & Humphreys, "Physically Based Rendering", 4th ed., §6.2.4.
#pragma once

#include <cmath>

#include "base/units.h"
#include "base/vec.h"

namespace troffer {

// The cone of a sphere whose centre lies on +z at `distance` > 1 from the receiver. Lengths are in
// units of the sphere's radius.
struct SphericalCap {
  double distance;
  double cos_max;        // cosine of the cone's half angle
  double one_minus_cos;  // 1 - cos_max without cancellation

  explicit SphericalCap(double distance_) : distance(distance_) {
    const double inverse = 1 / distance;
    cos_max = std::sqrt((distance - 1) * (distance + 1)) * inverse;
    one_minus_cos = inverse * inverse / (1 + cos_max);
  }
  double pdf_solid_angle() const { return 1 / (2 * pi * one_minus_cos); }

  struct Hit {
    Vec3d wi;      // unit direction
    double t = 0;  // distance to the hit
    Vec3d normal;  // outward unit normal of the sphere at the hit
  };
  // Returns a direction and its first hit for u in [0,1)².
  Hit sample(const Vec2d& u) const {
    const double drop = u.x * one_minus_cos;  // 1 - cos(theta)
    const double sin2 = drop * (2 - drop), cosine = 1 - drop;
    const double half_chord = std::sqrt(std::max(0.0, 1 - distance * distance * sin2));
    const double sine = std::sqrt(sin2), phi = 2 * pi * u.y;
    Hit hit;
    hit.wi = {sine * std::cos(phi), sine * std::sin(phi), cosine};
    // The product of both roots is distance² - 1.
    hit.t = (distance - 1) * (distance + 1) / (distance * cosine + half_chord);
    hit.normal = normalize(hit.wi * hit.t - Vec3d{0, 0, distance});
    return hit;
  }
  // Inverse of sample(), for a direction of any length.
  Vec2d square_from_direction(const Vec3d& w) const {
    const double r2 = w.x * w.x + w.y * w.y;
    const double norm = std::sqrt(w.z * w.z + r2);
    const double drop = r2 / (norm * (norm + w.z));
    double phi = std::atan2(w.y, w.x);
    if (phi < 0) phi += 2 * pi;
    return {drop / one_minus_cos, phi / (2 * pi)};
  }
};

}  // namespace troffer
