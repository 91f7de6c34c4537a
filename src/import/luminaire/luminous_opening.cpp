#include "import/luminaire/luminous_opening.h"

#include <algorithm>
#include <cmath>

#include "base/units.h"

namespace troffer {

namespace {

constexpr double least_size = 1e-4;  // m; smaller extents count as 0
constexpr float least_share = 1e-3f;

Vec3d area_of(const std::vector<Vec3d>& outline) {
  Vec3d sum;
  for (size_t i = 1; i + 1 < outline.size(); ++i)
    sum += cross(outline[i] - outline[0], outline[i + 1] - outline[0]) * 0.5;
  return sum;
}

// Returns the face, oriented towards `outward`.
OpeningFace face_of(std::vector<Vec3d> outline, const Vec3d& outward) {
  const Vec3d area = area_of(outline);
  if (dot(area, outward) >= 0) return {std::move(outline), area};
  std::reverse(outline.begin(), outline.end());
  return {std::move(outline), -area};
}

Vec3d axis_of(size_t a) {
  Vec3d v;
  v[a] = 1;
  return v;
}

// Returns the rectangle around `middle`, perpendicular to axis a, with the given half extents.
OpeningFace rectangle(const Vec3d& middle, const Vec3d& half, size_t a, double sign) {
  Vec3d b, c;
  b[(a + 1) % 3] = half[(a + 1) % 3];
  c[(a + 2) % 3] = half[(a + 2) % 3];
  return face_of({middle - b - c, middle + b - c, middle + b + c, middle - b + c},
                 axis_of(a) * sign);
}

void add_box(const LuminousOpening& o, OpeningBody& body) {
  const Vec3d half = o.size * 0.5;
  for (const double sign : {1.0, -1.0})
    body.faces.push_back(rectangle(axis_of(2) * (sign * half.z), half, 2, sign));
  constexpr std::array<size_t, 4> axes{0, 1, 0, 1};
  for (size_t i = 0; i < 4; ++i) {
    const double height = o.sides[i], sign = i < 2 ? 1 : -1;
    if (!(height > least_size)) continue;
    Vec3d middle = axis_of(axes[i]) * (sign * half[axes[i]]), own = half;
    middle.z = half.z - height / 2;
    own.z = height / 2;
    body.faces.push_back(rectangle(middle, own, axes[i], sign));
  }
}

// Returns the corners of an ellipse's polygon, perpendicular to axis a.
std::vector<Vec3d> ellipse(const Vec3d& size, size_t a) {
  // A factor on the radius gives the polygon the ellipse's area.
  constexpr double step = 2 * pi / circle_corners;
  const double radius = std::sqrt(step / std::sin(step));
  std::vector<Vec3d> outline;
  for (int i = 0; i < circle_corners; ++i) {
    Vec3d p;
    p[(a + 1) % 3] = 0.5 * size[(a + 1) % 3] * radius * std::cos(step * (i + 0.5));
    p[(a + 2) % 3] = 0.5 * size[(a + 2) % 3] * radius * std::sin(step * (i + 0.5));
    outline.push_back(p);
  }
  return outline;
}

void add_cylinder(const LuminousOpening& o, size_t a, OpeningBody& body) {
  const std::vector<Vec3d> outline = ellipse(o.size, a);
  const Vec3d half = axis_of(a) * (0.5 * o.size[a]);
  const bool is_flat = !(o.size[a] > least_size);
  for (const double sign : {1.0, -1.0}) {
    std::vector<Vec3d> cap = outline;
    for (Vec3d& p : cap) p += half * sign;
    body.faces.push_back(face_of(std::move(cap), axis_of(a) * sign));
    if (is_flat) return;
  }
  for (size_t i = 0; i < outline.size(); ++i) {
    const Vec3d &p = outline[i], &q = outline[(i + 1) % outline.size()];
    body.faces.push_back(face_of({p - half, q - half, q + half, p + half}, p + q));
  }
}

}  // namespace

LuminousOpening ies_opening(double width, double length, double height, bool is_before_2002) {
  LuminousOpening o;
  o.size = {std::abs(length), std::abs(width), std::abs(height)};
  o.is_round = {length < 0, width < 0, height < 0};
  bool &x = o.is_round[0], &y = o.is_round[1];
  const bool is_upright = height >= 0;
  if (is_before_2002 && !is_upright && (length > 0 || width > 0)) {
    // A cylinder whose diameter is the height, or an ellipsoid marked by a single sign.
    if (width == 0) o.size.y = o.size.z;
    if (length == 0) o.size.x = o.size.z;
    x = length <= 0 || width < 0;
    y = width <= 0 || length < 0;
    o.is_round[2] = x || y;
  }
  if (x != y && (is_upright || (is_before_2002 && o.size[x ? 1 : 0] == 0))) {
    // A circle with one diameter, or an ellipse marked by a single sign.
    if (o.size.x == 0) o.size.x = o.size.y;
    if (o.size.y == 0) o.size.y = o.size.x;
    x = y = true;
  }
  o.sides.fill(o.size.z);
  return o;
}

LuminousOpening eulumdat_opening(double length, double width, const std::array<double, 4>& sides) {
  LuminousOpening o;
  const bool is_circle = width == 0;
  o.size = {std::abs(is_circle ? length : width), std::abs(length), 0};
  o.is_round = {is_circle, is_circle, false};
  for (size_t i = 0; i < 4; ++i) {
    o.sides[i] = std::abs(sides[i]);
    o.size.z = std::max(o.size.z, o.sides[i]);
  }
  return o;
}

OpeningBody body_of(const LuminousOpening& o) {
  OpeningBody body;
  const auto is_there = [&](size_t a) { return o.size[a] > least_size; };
  const int extents = int(is_there(0)) + int(is_there(1)) + int(is_there(2));
  if (extents < 2) return body;
  body.shape = OpeningBody::Shape::faces;
  const int round = int(o.is_round[0]) + int(o.is_round[1]) + int(o.is_round[2]);
  if (round == 3 && extents == 3) {
    body.shape = OpeningBody::Shape::sphere;
    body.radius = 0.5 * std::cbrt(o.size.x * o.size.y * o.size.z);
    return body;
  }
  for (size_t a = 0; round == 2 && a < 3; ++a) {
    const size_t b = (a + 1) % 3, c = (a + 2) % 3;
    if (o.is_round[a] || !is_there(b) || !is_there(c)) continue;
    if (a == 2 && o.size.x == o.size.y && !is_there(2)) {
      body.shape = OpeningBody::Shape::disc;
      body.radius = 0.5 * o.size.x;
    } else {
      add_cylinder(o, a, body);
    }
    return body;
  }
  if (extents == 3) {
    add_box(o, body);
    return body;
  }
  for (size_t a = 0; a < 3; ++a)
    if (!is_there(a)) body.faces.push_back(rectangle({}, o.size * 0.5, a, 1));
  return body;
}

bool shines_towards(const LightWeb& web, const Vec3d& normal) {
  const auto axes = axes_of(web.pole);
  const Vec3 n(normalize(normal));
  const Vec3 own{dot(n, axes[0]), dot(n, axes[1]), dot(n, axes[2])};
  const float least =
      least_share * *std::max_element(web.intensities.begin(), web.intensities.end());
  const size_t heights = web.vertical_angles_rad.size();
  // Test each plane and the interpolated directions up to the next plane, which may be 360° away.
  constexpr int parts = 36;
  for (size_t i = 0; i + 1 < web.horizontal_angles_rad.size(); ++i)
    for (size_t j = 0; j < heights; ++j) {
      const float here = web.intensities[i * heights + j],
                  next = web.intensities[(i + 1) * heights + j];
      const float z = std::cos(web.vertical_angles_rad[j]),
                  r = std::sin(web.vertical_angles_rad[j]);
      for (int part = 0; part <= parts && std::max(here, next) > least; ++part) {
        const float t = float(part) / float(parts);
        const float turn =
            std::lerp(web.horizontal_angles_rad[i], web.horizontal_angles_rad[i + 1], t);
        const Vec3 w{r * std::cos(turn), r * std::sin(turn), z};
        if (std::lerp(here, next, t) > least && dot(own, w) > 1e-4f) return true;
      }
    }
  return false;
}

}  // namespace troffer
