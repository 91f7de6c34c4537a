// Nearly uniform sampling of the solid angle of a disk seen from anywhere, with density and
// inverse.
//
// From the receiver a disk is an elliptic cone: a spherical ellipse [1]. Around the cone's axis,
// the cone's edge lies at theta_max(phi), and sin(theta_max) is the radius at phi of the flat
// ellipse of half axes sin(alpha), sin(beta), half the cone's opening angles. We take phi in
// proportion to that ellipse's area, and then cos(theta) uniformly between cos(theta_max) and 1.
// The density
//   (sin²(theta_max) / (2 pi sin(alpha) sin(beta))) / (1 - cos(theta_max))
//   = (1 + cos(theta_max)) / (2 pi sin(alpha) sin(beta))
// stays within a factor of two of the uniform one everywhere, and needs no elliptic integral, which
// the uniform density does [1, section 4].
// References: [1] Guillén, Ureña, King, Fajardo, Georgiev, López-Moreno & Jarabo, "Area-Preserving
//   Parameterizations for Spherical Ellipses", EGSR 2017.
#pragma once

#include <cmath>

#include "base/frame.h"
#include "base/units.h"
#include "base/vec.h"
#include "base/warp.h"

namespace troffer {

// A disk seen by a receiver, in units of its radius. Coordinates in the disk's plane: `a` points
// from the centre to the receiver's foot; b = m × a, with the normal m on the receiver's side.
struct SphericalDisk {
  double rho = 0, height = 0;  // receiver at rho a + height m, height > 0
  // squared sines of the half opening angles along and across b
  double sin_alpha2 = 0, sin_beta2 = 0;
  double cot_alpha2 = 0, cot_beta2 = 0;  // squared cotangents of the same angles
  double axis_a = 0, axis_m = 0;         // unit vector of the cone's axis (its b component is 0)

  // rho_: distance of the receiver's foot from the centre; both in radii.
  SphericalDisk(double rho_, double height_) : rho(rho_), height(height_) {
    const double rr = rho * rho, hh = height * height;
    // s: nearest times farthest distance of the rim.
    const double q = rr + hh - 1;
    const double s = std::sqrt(q * q + 4 * hh);
    const double plus = q > 0 ? s + q : 4 * hh / (s - q);  // s + q without cancellation
    // s - q likewise; the product is 4 height²
    const double minus = q > 0 ? 4 * hh / (s + q) : s - q;
    const double sum = plus + 2;  // half the squared sum of those two distances
    sin_alpha2 = 2 / sum;
    cot_alpha2 = plus / 2;
    sin_beta2 = minus / (2 * s);
    cot_beta2 = plus / minus;
    // The axis bisects the angle between the nearest and the farthest point of the rim.
    const double along = rho * plus / sum;
    const double scale = -1 / std::sqrt(along * along + hh);
    axis_a = along * scale;
    axis_m = height * scale;
  }

  double pdf_from_cos_max(double cos_max) const {
    return (1 + cos_max) / (2 * pi * std::sqrt(sin_alpha2 * sin_beta2));
  }
  // Returns cos(theta_max) for a direction whose component across the axis is (t, b).
  double cos_max(double t, double b) const {
    const double tt = t * t, bb = b * b;
    if (!(tt + bb > 0)) return std::sqrt(1 - sin_beta2);
    const double outside = tt * cot_beta2 + bb * cot_alpha2;
    return std::sqrt(outside / (outside + tt + bb));
  }

  // Returns the point (a, b) of the disk for u in [0,1)², and its density per steradian. The
  // concentric map carries the square to the ellipse.
  Vec2d sample(const Vec2d& u, double& pdf_solid_angle) const {
    const Vec2d d = disk_from_square(u);
    const double r2 = d.x * d.x + d.y * d.y;
    Vec2d e{std::sqrt(sin_beta2) * d.x, std::sqrt(sin_alpha2) * d.y};
    const double cosine_max = cos_max(e.x, e.y);
    pdf_solid_angle = pdf_from_cos_max(cosine_max);
    const double ee = e.x * e.x + e.y * e.y;    // r2 sin²(theta_max)
    const double drop = ee / (1 + cosine_max);  // 1 - cos(theta)
    const double sin_theta = std::sqrt(drop * (2 - drop));
    if (r2 > 0) e = e * (sin_theta / std::sqrt(ee));
    // Direction in (a, b, m): the axis, and its perpendicular in the plane of symmetry.
    const double w_a = (1 - drop) * axis_a - e.x * axis_m;
    const double w_m = (1 - drop) * axis_m + e.x * axis_a;
    const double t = w_m < 0 ? -height / w_m : 0;
    Vec2d p{rho + t * w_a, t * e.y};
    const double pp = dot(p, p);
    if (pp > 1) p = p * (1 / std::sqrt(pp));
    return p;
  }

  // Density per steradian with which sample() returns the point (a, b) of the disk.
  double pdf_solid_angle(const Vec2d& p) const {
    const double wa = p.x - rho;
    return pdf_from_cos_max(cos_max(-wa * axis_m - height * axis_a, p.y));
  }

  Vec2d square_from_point(const Vec2d& p) const {
    const double wa = p.x - rho, distance = std::sqrt(wa * wa + p.y * p.y + height * height);
    const double t = (-wa * axis_m - height * axis_a) / distance, b = p.y / distance;
    const double across2 = t * t + b * b;
    if (!(across2 > 0)) return {0.5, 0.5};
    const double cosine = (wa * axis_a - height * axis_m) / distance;
    const double drop = cosine > 0 ? across2 / (1 + cosine) : 1 - cosine;
    const double cosine_max = cos_max(t, b);
    const double sin_max2 = across2 / (t * t * (1 + cot_beta2) + b * b * (1 + cot_alpha2));
    const double r = std::sqrt(drop * (1 + cosine_max) / sin_max2);
    Vec2d d{t / std::sqrt(sin_beta2), b / std::sqrt(sin_alpha2)};
    return square_from_disk(d * (std::min(r, 1.0) / std::sqrt(dot(d, d))));
  }
};

}  // namespace troffer
