// Reference values of unoccluded irradiance by adaptive quadrature in long double. Sums have
// positive terms only, so nothing cancels. Also receivers that are difficult for closed forms.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "base/frame.h"
#include "base/random.h"
#include "base/units.h"
#include "base/vec.h"
#include "support/quadrature.h"

namespace troffer::test {

using Vec3l = Vec3T<long double>;

struct Reference {
  Vec3l n;             // normal of the receiver
  Vec3l m;             // unit normal of the source's plane
  long double height;  // distance of the receiver from it

  // Integrates over a triangle above the receiver's horizon; corners are relative to the receiver.
  long double triangle(const Vec3l& a, const Vec3l& b, const Vec3l& c, int depth = 0) const {
    const long double ab = length_squared(b - a), bc = length_squared(c - b),
                      ca = length_squared(a - c), longest = std::max({ab, bc, ca});
    // Lower bound of the distance, from the corners and the distance to the plane.
    const long double corner =
        std::sqrt(std::min({length_squared(a), length_squared(b), length_squared(c)}));
    const long double nearest = std::max(height, corner - std::sqrt(longest));
    if (longest > 0.16L * nearest * nearest && depth < 60) {
      if (longest == ab) return halves(a, b, c, depth);
      return longest == bc ? halves(b, c, a, depth) : halves(c, a, b, depth);
    }
    const auto& rule = gauss_legendre<long double>(8);
    const long double area = length(cross(b - a, c - a));
    long double sum = 0;
    for (size_t i = 0; i < 8; ++i)
      for (size_t j = 0; j < 8; ++j) {
        const long double s = rule.nodes[i], t = s * rule.nodes[j];
        const Vec3l y = a + (b - a) * (s - t) + (c - a) * t;
        const long double square = length_squared(y);
        sum += rule.weights[i] * rule.weights[j] * s * dot(n, y) / (square * square);
      }
    return sum * area * height;
  }
  long double halves(const Vec3l& a, const Vec3l& b, const Vec3l& c, int depth) const {
    const Vec3l middle = (a + b) * 0.5L;
    return triangle(a, middle, c, depth + 1) + triangle(middle, b, c, depth + 1);
  }
};

inline double polygon_reference(const std::vector<Vec3d>& polygon, const Vec3d& m, const Vec3d& x,
                                const Vec3d& n) {
  std::vector<Vec3l> above;
  const Vec3l normal(n), origin(x);
  for (size_t i = 0; i < polygon.size(); ++i) {
    const Vec3l p = Vec3l(polygon[i]) - origin,
                q = Vec3l(polygon[(i + 1) % polygon.size()]) - origin;
    const long double hp = dot(normal, p), hq = dot(normal, q);
    if (hp >= 0) above.push_back(p);
    if ((hp < 0) != (hq < 0)) above.push_back(p + (q - p) * (hp / (hp - hq)));
  }
  if (above.size() < 3) return 0;
  Vec3l area;
  for (size_t i = 1; i + 1 < polygon.size(); ++i)
    area += cross(Vec3l(polygon[i]) - Vec3l(polygon[0]), Vec3l(polygon[i + 1]) - Vec3l(polygon[0]));
  if (dot(area, Vec3l(m)) < 0) area = -area;
  const Vec3l plane = area / length(area);
  const Reference r{normal, plane, std::abs(dot(plane, origin - Vec3l(polygon[0])))};
  long double sum = 0;
  for (size_t i = 1; i + 1 < above.size(); ++i) sum += r.triangle(above[0], above[i], above[i + 1]);
  return double(sum);
}

// Integrates over chords parallel to the horizon: their height over it is constant.
inline double disk_reference(const Vec3d& centre, const Vec3d& m, double radius, const Vec3d& x,
                             const Vec3d& n) {
  const Vec3l plane(m), normal(n), c = Vec3l(centre) - Vec3l(x);
  Vec3l up = normal - plane * (dot(plane, normal) / length_squared(plane));
  const long double slope = length(up);
  up = slope > 1e-15L ? up / slope : Vec3l(Framed(m).tangent);
  const Vec3l along = normalize(cross(plane, up));
  const long double middle = dot(normal, c), rise = dot(normal, up), r = radius;
  const long double height = std::abs(dot(plane, c)) / length(plane);
  long double first = -std::acos(-1.0L) / 2;
  if (middle <= -rise * r) return 0;
  if (middle < rise * r) first = std::asin(-middle / (rise * r));
  const auto f = [&](long double a, long double w) {
    const long double half = r * std::cos(a);
    const Vec3l y = c + up * (r * std::sin(a)) + along * (half * w);
    const long double square = length_squared(y);
    return half * half * std::max(dot(normal, y), 0.0L) / (square * square);
  };
  const long double last = std::acos(-1.0L) / 2;
  const long double rough = integrate_2d(f, first, last, -1.0L, 1.0L, 6);
  return double(height * integrate_adaptive_2d(f, first, last, -1.0L, 1.0L, 1e-7L * rough, 6, 14));
}

// Integrates over cones about the direction of the centre; the part above the horizon has a closed
// form.
inline double sphere_reference(const Vec3d& centre, double radius, const Vec3d& x, const Vec3d& n) {
  const Vec3l c = Vec3l(centre) - Vec3l(x), normal(n);
  const long double d = length(c), half_pi = std::acos(-1.0L) / 2;
  const long double r = radius, last = std::asin(std::min(r / d, 1.0L));
  const long double cosine = dot(normal, c) / d, sine = length(cross(normal, c)) / d;
  const auto ring = [&](long double a) -> long double {
    const long double p = std::cos(a) * cosine, q = std::sin(a) * sine;
    if (p >= q) return 4 * half_pi * p * std::sin(a);
    if (p <= -q) return 0;
    const long double t = std::acos(-p / q);
    return 2 * (p * t + q * std::sin(t)) * std::sin(a);
  };
  // angle of the horizon from the centre's direction
  const long double kink = std::abs(half_pi - std::atan2(sine, cosine));
  const auto part = [&](long double from, long double to, bool at_start) {
    const long double size = to - from;
    const auto g = [&](long double u) {
      return ring(at_start ? from + size * u * u : to - size * u * u) * 2 * size * u;
    };
    const long double rough = integrate(g, 0.0L, 1.0L, 16);
    return integrate_adaptive(g, 0.0L, 1.0L, 1e-8L * rough, 16);
  };
  if (kink >= last) return double(part(0, last, true));
  return double(part(0, kink, false) + part(kink, last, true));
}

// A receiver for a flat source of size `size` and normal m around `point`, which lies on it.
// Positions range from near to far and low over the source's plane; normals put the source low over
// the horizon or across it.
struct HardReceiver {
  Vec3 position, normal;
};
inline HardReceiver hard_receiver(Random& r, const Vec3d& point, const Vec3d& m, double size) {
  const Framed frame(m);
  const double away = size * std::pow(10.0, -1.5 + 4 * r.next_double());
  const double low = r.next_double() < 0.5 ? 1 : std::pow(10.0, -4 * r.next_double());
  const double a = 2 * pi * r.next_double();
  const Vec3d out = normalize(frame.to_world({std::cos(a), std::sin(a), low}));
  HardReceiver h;
  h.position = Vec3(point + out * away);
  const Vec3d towards = normalize(point - Vec3d(h.position));
  const Framed view(towards);
  const double b = 2 * pi * r.next_double();
  const Vec3d side = view.to_world({std::cos(b), std::sin(b), 0});
  const double tilt =
      r.next_double() < 0.4 ? r.next_double() * 2 - 0.3 : std::pow(10.0, -5 * r.next_double());
  h.normal = normalize(Vec3(side + towards * tilt));
  return h;
}

// A convex polygon, counterclockwise about m, of random size and shape, down to slivers.
struct RandomPolygon {
  std::vector<Vec3d> corners;
  Vec3d m;
  double size;
};
inline RandomPolygon random_polygon(Random& r) {
  RandomPolygon p;
  p.size = std::pow(10.0, -2 + 3 * r.next_double());
  const double width = p.size * std::pow(10.0, -4 * r.next_double() * r.next_double());
  Vec3d m;
  do {
    m = Vec3d{r.next_double(), r.next_double(), r.next_double()} * 2.0 - Vec3d(1.0);
  } while (!(length_squared(m) > 0.01 && length_squared(m) < 1));
  const Framed frame(normalize(m));  // not rounded: rounded corners would not be coplanar
  const int n = 3 + int(4 * r.next_double());
  const double turn = 2 * pi * r.next_double();
  for (int i = 0; i < n; ++i) {
    const double a = turn + 2 * pi * (i + 0.6 * r.next_double()) / n;
    p.corners.push_back(frame.tangent * (p.size * std::cos(a)) +
                        frame.bitangent * (width * std::sin(a)));
  }
  p.m = frame.normal;
  return p;
}

}  // namespace troffer::test
