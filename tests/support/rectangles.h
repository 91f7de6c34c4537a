// Reference solution for diffuse rectangles that illuminate one another, by a method that is
// independent of the program's: form factors from points to rectangles by Lambert's formula,
// collocation at the centres of elements, and extrapolation over two element sizes.
//
// No rectangle may hide another.
// References: [1] Cohen & Wallace, "Radiosity and Realistic Image Synthesis", 1993, ch. 3 and 4.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "support/scenes.h"

namespace troffer::test {

struct Rectangle {
  Vec3d corner, u, v;  // the front is on the side of u × v
  double reflectance = 0;
  double radiance = 0;
};

// Returns the form factor from a point to the part of corner + [0,1] u + [0,1] v that is above its
// horizon.
inline double form_factor(const Vec3d& x, const Vec3d& n, const Vec3d& corner, const Vec3d& u,
                          const Vec3d& v) {
  const std::array<Vec3d, 4> corners{corner - x, corner + u - x, corner + u + v - x,
                                     corner + v - x};
  std::vector<Vec3d> p;
  for (size_t i = 0; i < 4; ++i) {
    const Vec3d &a = corners[i], &b = corners[(i + 1) % 4];
    const double above_a = dot(n, a), above_b = dot(n, b);
    if (above_a >= 0) p.push_back(a);
    if ((above_a < 0) != (above_b < 0)) p.push_back(a + (b - a) * (above_a / (above_a - above_b)));
  }
  double sum = 0;
  for (size_t i = 0; i < p.size(); ++i) {
    const Vec3d &a = p[i], &b = p[(i + 1) % p.size()], c = cross(a, b);
    const double sine = length(c);
    if (sine > 0) sum += std::atan2(sine, dot(a, b)) * dot(n, c) / sine;
  }
  return std::abs(sum) / (2 * std::acos(-1.0));
}

// Irradiance at points after all reflections.
class RectangleSolution {
 public:
  // Elements are at most `size` long.
  RectangleSolution(const std::vector<Rectangle>& rectangles, double size) {
    for (const Rectangle& r : rectangles) {
      const int nu = std::max(1, int(std::ceil(length(r.u) / size - 1e-9)));
      const int nv = std::max(1, int(std::ceil(length(r.v) / size - 1e-9)));
      for (int i = 0; i < nu; ++i)
        for (int j = 0; j < nv; ++j)
          elements_.push_back({r.corner + r.u * (double(i) / nu) + r.v * (double(j) / nv),
                               r.u / double(nu), r.v / double(nv), normalize(cross(r.u, r.v)),
                               r.reflectance, r.radiance});
    }
    const size_t n = elements_.size();
    std::vector<double> factors(n * n);
    for (size_t i = 0; i < n; ++i)
      for (size_t j = 0; j < n; ++j)
        factors[i * n + j] = factor(middle(elements_[i]), elements_[i].normal, elements_[j]);
    sent_.resize(n);
    for (size_t j = 0; j < n; ++j) sent_[j] = emitted(elements_[j]);
    for (double change = 1; change > 1e-9;) {
      change = 0;
      for (size_t i = 0; i < n; ++i) {  // Gauss–Seidel [1]
        double e = 0;
        for (size_t j = 0; j < n; ++j) e += factors[i * n + j] * sent_[j];
        const double sent = emitted(elements_[i]) + elements_[i].reflectance * e;
        change = std::max(change, std::abs(sent - sent_[i]));
        sent_[i] = sent;
      }
    }
  }

  double irradiance(const Vec3d& x, const Vec3d& n) const {
    double e = 0;
    for (size_t j = 0; j < elements_.size(); ++j) e += factor(x, n, elements_[j]) * sent_[j];
    return e;
  }

 private:
  struct Element {
    Vec3d corner, u, v, normal;
    double reflectance, radiance;
  };

  static Vec3d middle(const Element& e) { return e.corner + (e.u + e.v) * 0.5; }
  static double emitted(const Element& e) { return std::acos(-1.0) * e.radiance; }
  static double factor(const Vec3d& x, const Vec3d& n, const Element& e) {
    const Vec3d away = x - e.corner;
    const double height = dot(away, e.normal);
    if (height <= 1e-12) return 0;  // back side, or coplanar with the point
    return form_factor(x, n, e.corner, e.u, e.v);
  }

  std::vector<Element> elements_;
  std::vector<double> sent_;  // radiosity, including emission
};

// Irradiance extrapolated from elements of 1/2 and 1/3 of a size; errors fall as its square.
class ExtrapolatedSolution {
 public:
  ExtrapolatedSolution(const std::vector<Rectangle>& rectangles, double size)
      : coarse_(rectangles, size / 2), fine_(rectangles, size / 3) {}
  double irradiance(const Vec3d& x, const Vec3d& n) const {
    return (9 * fine_.irradiance(x, n) - 4 * coarse_.irradiance(x, n)) / 5;
  }
  // Returns the change by the last step of extrapolation.
  double doubt(const Vec3d& x, const Vec3d& n) const {
    return std::abs(irradiance(x, n) - fine_.irradiance(x, n));
  }

 private:
  RectangleSolution coarse_, fine_;
};

inline Scene scene_of(const std::vector<Rectangle>& rectangles) {
  Scene s;
  for (const Rectangle& r : rectangles) {
    const Vec3d &a = r.corner, b = a + r.u, c = b + r.v, d = a + r.v;
    const uint32_t quad = add_quad(s, add_diffuse(s, Rgb{float(r.reflectance)}),
                                   {Vec3(a), Vec3(b), Vec3(c), Vec3(d)});
    if (r.radiance > 0) make_light(s, quad, Rgb{float(r.radiance)});
  }
  return s;
}

}  // namespace troffer::test
