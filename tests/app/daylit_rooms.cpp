#include "daylit_rooms.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "base/units.h"
#include "support/quadrature.h"

namespace troffer::test {

namespace {

std::string rectangles_of(const std::vector<Rectangle>& rectangles, const std::string& material) {
  std::string text = material;
  for (const Rectangle& r : rectangles) {
    text +=
        "Shape \"trianglemesh\" \"integer indices\" [0 1 2 0 2 3] "
        "\"point3 P\" [";
    for (const Vec3d& p :
         {r.corner, r.corner + r.along, r.corner + r.along + r.across, r.corner + r.across})
      text += fmt::format("{:.9g} {:.9g} {:.9g}  ", p.x, p.y, p.z);
    text += "]\n";
  }
  return text;
}

}  // namespace

std::string pbrt_rectangles(const std::vector<Rectangle>& rectangles, double reflectance) {
  return rectangles_of(
      rectangles,
      fmt::format("Material \"diffuse\" \"rgb reflectance\" [{0} {0} {0}]\n", reflectance));
}

std::string pbrt_glass(const std::vector<Rectangle>& rectangles) {
  return rectangles_of(rectangles, "Material \"thindielectric\" \"float eta\" 1.5\n");
}

Rectangle Room::opening() const {
  if (has_roof_opening) return {{-width / 2, -height / 2, 3}, {width, 0, 0}, {0, height, 0}};
  return {{-width / 2, -2, sill}, {width, 0, 0}, {0, 0, height}};
}

namespace {

// Adds a rectangle without a hole; `hole` is given as (u, v) along its sides.
void add_around(const Rectangle& whole, const std::array<double, 4>& hole,
                std::vector<Rectangle>& out) {
  const auto part = [&](double u0, double u1, double v0, double v1) {
    if (u1 - u0 < 1e-9 || v1 - v0 < 1e-9) return;
    out.push_back({whole.corner + whole.along * u0 + whole.across * v0, whole.along * (u1 - u0),
                   whole.across * (v1 - v0)});
  };
  part(0, hole[0], 0, 1);
  part(hole[1], 1, 0, 1);
  part(hole[0], hole[1], 0, hole[2]);
  part(hole[0], hole[1], hole[3], 1);
}

}  // namespace

std::vector<Rectangle> Room::walls() const {
  const Vec3d x{4, 0, 0}, y{0, 4, 0}, z{0, 0, 3};
  std::vector<Rectangle> all{{{-2, -2, 0}, x, y},  // floor
                             {{-2, 2, 0}, x, z},   // north, west, east
                             {{-2, -2, 0}, y, z},
                             {{2, -2, 0}, y, z}};
  const Rectangle south{{-2, -2, 0}, x, z}, ceiling{{-2, -2, 3}, x, y};
  const double u0 = (2 - width / 2) / 4, u1 = (2 + width / 2) / 4;
  if (has_roof_opening) {
    all.push_back(south);
    add_around(ceiling, {u0, u1, (2 - height / 2) / 4, (2 + height / 2) / 4}, all);
  } else {
    all.push_back(ceiling);
    add_around(south, {u0, u1, sill / 3, (sill + height) / 3}, all);
  }
  return all;
}

Luminance cie_sky_of(int type, double ground_reflectance) {
  // [2]: a, b: gradation; c, d, e: indicatrix
  static constexpr double table[15][5] = {
      {4, -.7, 0, -1, 0},       {4, -.7, 2, -1.5, .15},  {1.1, -.8, 0, -1, 0},
      {1.1, -.8, 2, -1.5, .15}, {0, -1, 0, -1, 0},       {0, -1, 2, -1.5, .15},
      {0, -1, 5, -2.5, .3},     {0, -1, 10, -3, .45},    {-1, -.55, 2, -1.5, .15},
      {-1, -.55, 5, -2.5, .3},  {-1, -.55, 10, -3, .45}, {-1, -.32, 10, -3, .45},
      {-1, -.32, 16, -3, .3},   {-1, -.15, 16, -3, .3},  {-1, -.15, 24, -2.8, .15}};
  const auto& t = table[type - 1];
  const Vec3d sun{0, -std::cos(rad_from_deg(60.0)), std::sin(rad_from_deg(60.0))};
  const auto relative = [t, sun](const Vec3d& w) {
    const double x = std::acos(std::clamp(dot(w, sun), -1.0, 1.0));
    return (1 + t[0] * std::exp(t[1] / std::max(w.z, 1e-9))) *
           (1 + t[2] * (std::exp(t[3] * x) - std::exp(t[3] * pi / 2)) +
            t[4] * std::cos(x) * std::cos(x));
  };
  const double horizontal = integrate_2d(
      [&](double z, double a) {
        const Vec3d w{std::sin(z) * std::sin(a), std::sin(z) * std::cos(a), std::cos(z)};
        return relative(w) * std::sin(z) * w.z;
      },
      0.0, pi / 2, 0.0, 2 * pi, 200);
  return [=](const Vec3d& w) {
    return 10'000 * (w.z > 0 ? relative(w) / horizontal : ground_reflectance / pi);
  };
}

double illuminance_through(
    const Rectangle& o, const Point& p,
    const std::function<double(const Vec3d& from, const Vec3d& towards)>& luminance,
    std::vector<double> cuts) {
  const Vec3d outward = normalize(cross(o.along, o.across));
  const auto integrand = [&](double u, double v) {
    const Vec3d d = o.corner + o.along * u + o.across * v - p.position;
    const double d2 = dot(d, d);
    const Vec3d w = d * (1 / std::sqrt(d2));
    const double cosine = dot(w, p.normal);
    return cosine > 0 ? luminance(p.position, w) * cosine * std::abs(dot(w, outward)) / d2 : 0.0;
  };
  const double area = length(o.along) * length(o.across);
  std::vector<double> ends{0, 1};
  for (const double z : cuts)
    if (const double v = (z - o.corner.z) / o.across.z; v > 0 && v < 1) ends.push_back(v);
  std::sort(ends.begin(), ends.end());
  double sum = 0;
  for (size_t i = 0; i + 1 < ends.size(); ++i)
    sum += integrate_adaptive_2d(integrand, 0.0, 1.0, ends[i], ends[i + 1], 1e-3);
  return sum * area;
}

double illuminance_of(const Rectangle& even, const Point& p, double luminance) {
  // Clip the rectangle to the point's horizon.
  const Vec3d corners[] = {even.corner, even.corner + even.along,
                           even.corner + even.along + even.across, even.corner + even.across};
  std::vector<Vec3d> seen;
  for (size_t i = 0; i < 4; ++i) {
    const Vec3d a = corners[i] - p.position, b = corners[(i + 1) % 4] - p.position;
    const double ha = dot(a, p.normal), hb = dot(b, p.normal);
    if (ha >= 0) seen.push_back(a);
    if ((ha < 0) != (hb < 0)) seen.push_back(a + (b - a) * (ha / (ha - hb)));
  }
  double sum = 0;
  for (size_t i = 0; i < seen.size(); ++i) {
    const Vec3d a = seen[i], b = seen[(i + 1) % seen.size()], c = cross(a, b);
    if (const double sine = length(c); sine > 0)
      sum += std::atan2(sine, dot(a, b)) * dot(c, p.normal) / sine;
  }
  return 0.5 * luminance * std::abs(sum);
}

double pane_transmittance(double cosine) {
  constexpr double n = 1.5;
  const double inside = std::sqrt(1 - (1 - cosine * cosine) / (n * n));
  double mean = 0;
  for (const double r : {(cosine - n * inside) / (cosine + n * inside),
                         (n * cosine - inside) / (n * cosine + inside)})
    mean += 0.5 * (1 - r * r) / (1 + r * r);
  return mean;
}

}  // namespace troffer::test
