// Irradiance of spheres and disks (irradiance.h).
#include <cmath>

#include "base/frame.h"
#include "base/units.h"
#include "light/irradiance.h"
#include "light/receiver_view.h"

namespace troffer {

// Both functions normalize the normal, which is given in single precision. The closed forms are
// differences of terms that scale differently with its length. Low over the horizon, an error of
// 1e-7 would become 1e-3 of the result.

double sphere_irradiance(const Vec3d& centre, double radius, const Vec3d& x, const Vec3d& normal,
                         Sides sides, bool is_inside_out) {
  const Vec3d to_centre = centre - x;
  const double d = length(to_centre);
  const bool is_inside = d <= radius + rounding_of_sphere(centre, radius);
  if (sides == Sides::front && is_inside != is_inside_out) return 0;
  if (is_inside) return pi;
  const Vec3d n = normalize(normal);
  const double cos_theta = dot(n, to_centre) / d;
  const double q = sqr(radius / d);
  // Entirely above or below the horizon where cos² > q. The rest is in terms of x² = 1/q - 1.
  const double tangent2 = (d - radius) * (d + radius) / sqr(radius);
  if (sqr(cos_theta) >= q) return cos_theta > 0 ? pi * q * cos_theta : 0;
  const double sin_theta = length(cross(n, to_centre)) / d;
  const double tangent = std::sqrt(tangent2);
  const double y = std::clamp(-tangent * cos_theta / sin_theta, -1.0, 1.0);
  const double k = sin_theta * std::sqrt((1 - y) * (1 + y));
  // atan(k / x) - q x k cancels for far spheres. With t = 1/x it is atan(k t) - k t / (1 + t²),
  // which is expanded in t.
  double rest;
  const double t = 1 / tangent;
  if (t < 1e-2) {
    const double kk = k * k, tt = t * t;
    rest = k * t * tt * ((1 - kk / 3) - tt * ((1 - kk * kk / 5) - tt * (1 - kk * kk * kk / 7)));
  } else {
    rest = std::atan2(k, tangent) - q * tangent * k;
  }
  return std::clamp(q * cos_theta * std::acos(y) + rest, 0.0, pi);
}

namespace {

// The rim seen from the receiver: r(phi) = (cos(phi) - rho) a + sin(phi) b - h m in units of the
// radius. Vector a points towards the receiver's foot, and m to the receiver's side. Then (r ×
// dr/dphi) · (na, nb, nm) is nm + (h na - rho nm) cos(phi) + h nb sin(phi), and |r|² = A - B
// cos(phi).
struct Rim {
  double rho, h, na, nb, nm;
  double s;         // sqrt(A² - B²): nearest times farthest distance
  double a_plus_s;  // A + s

  Rim(double rho_, double h_, double na_, double nb_, double nm_)
      : rho(rho_), h(h_), na(na_), nb(nb_), nm(nm_) {
    const double q = rho * rho + h * h - 1;
    s = std::sqrt(q * q + 4 * h * h);
    a_plus_s = rho * rho + h * h + 1 + s;
  }

  // Value for the whole rim: -1/2 times the integral over the circle.
  double whole() const {
    const double p = 1 + h * h - rho * rho;  // p² + 4 rho² h² = s²
    const double p_plus_s = p > 0 ? p + s : 4 * sqr(rho * h) / (s - p);
    return -pi / s * (nm * p_plus_s + 2 * rho * h * na) / a_plus_s;
  }

  // The integral from phi0 to phi1, phi1 - phi0 in (0, 2 pi], without the chord. With beta = B / (A
  // + s), 1 / (A - B cos(phi)) = (1 + 2 sum beta^k cos(k phi)) / s. Its integral (phi + 2 w(phi)) /
  // s, w = atan(beta sin(phi) / (1 - beta cos(phi))), has no branch cut.
  double arc(double phi0, double phi1) const {
    const double b = 2 * rho, a = rho * rho + h * h + 1, beta = b / a_plus_s;
    const double c0 = std::cos(phi0), c1 = std::cos(phi1);
    const double s0 = std::sin(phi0), s1 = std::sin(phi1);
    const double w = std::atan2(beta * s1, 1 - beta * c1) - std::atan2(beta * s0, 1 - beta * c0);
    const double w_over_b = beta > 1e-12 ? w / b : (s1 - s0) / a_plus_s;
    const double one = (phi1 - phi0 + 2 * w) / s;                         // ∫ 1 / |r|²
    const double cosine = ((phi1 - phi0) * beta + 2 * a * w_over_b) / s;  // ∫ cos / |r|²
    const double near0 = a - b * c0;
    const double change = b * (c0 - c1) / near0;
    const double sine = b > 1e-12 * a ? std::log1p(change) / b : (c0 - c1) / near0;
    return nm * one + (h * na - rho * nm) * cosine + h * nb * sine;
  }
};

}  // namespace

double disk_irradiance(const Vec3d& centre, const Vec3d& m, double radius, const Vec3d& x,
                       const Vec3d& normal, Sides sides) {
  const Vec3d from_centre = x - centre;
  const double signed_height = dot(m, from_centre);
  if (!(signed_height > 0 || (sides == Sides::both && signed_height < 0))) return 0;
  const Vec3d up = signed_height > 0 ? m : -m, n = normalize(normal);
  const Vec3d foot = from_centre - m * signed_height;
  const double foot_length = length(foot);
  const Vec3d a = foot_length > 1e-12 * radius ? foot / foot_length : Framed(up).tangent;
  const Vec3d b = cross(up, a);
  const Rim rim(foot_length / radius, std::abs(signed_height) / radius, dot(n, a), dot(n, b),
                dot(n, up));
  // Height of rim point phi over the horizon: swing cos(phi - towards) - middle.
  const double swing = std::hypot(rim.na, rim.nb), middle = rim.rho * rim.na + rim.h * rim.nm;
  if (middle >= swing) return 0;
  if (middle <= -swing) return std::clamp(rim.whole(), 0.0, pi);
  const double towards = std::atan2(rim.nb, rim.na);
  const double half = std::acos(middle / swing);
  const double phi0 = towards - half, phi1 = towards + half;
  // The chord lies in the horizon's plane and adds the angle it subtends. It runs from phi1 back to
  // phi0, clockwise seen from the zenith, because the visible part lies beyond it.
  const Vec3d r0{std::cos(phi0) - rim.rho, std::sin(phi0), -rim.h};
  const Vec3d r1{std::cos(phi1) - rim.rho, std::sin(phi1), -rim.h};
  const Vec3d turn = cross(r1, r0 - r1);
  const double chord = std::copysign(std::atan2(length(turn), dot(r0, r1)),
                                     dot(turn, Vec3d{rim.na, rim.nb, rim.nm}));
  return std::clamp(-0.5 * (rim.arc(phi0, phi1) + chord), 0.0, pi);
}

}  // namespace troffer
