#include "import/hbjson/hbjson_face.h"

#include <algorithm>
#include <cmath>

#include "import/polygon.h"

namespace troffer {

namespace {

using Point = Vec2T<double>;
using Polygon = std::vector<Point>;  // counterclockwise

double area_of(const Polygon& p) {
  double sum = 0;
  for (size_t i = 0; i < p.size(); ++i) {
    const Point &a = p[i], &b = p[(i + 1) % p.size()];
    sum += a.x * b.y - a.y * b.x;
  }
  return sum / 2;
}

// Twice the area of a, b, p: positive if p lies to the left of the edge.
double side_of(const Point& a, const Point& b, const Point& p) {
  return (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x);
}

bool is_convex(const Polygon& p) {
  for (size_t i = 0; i < p.size(); ++i)
    if (side_of(p[i], p[(i + 1) % p.size()], p[(i + 2) % p.size()]) < 0) return false;
  return true;
}

// Returns the part of a convex polygon to the left of the line a, b (or to the right).
Polygon part_beside(const Polygon& p, const Point& a, const Point& b, double sign) {
  Polygon out;
  for (size_t i = 0; i < p.size(); ++i) {
    const Point &from = p[i], &to = p[(i + 1) % p.size()];
    const double u = sign * side_of(a, b, from), v = sign * side_of(a, b, to);
    if (u >= 0) out.push_back(from);
    if ((u > 0 && v < 0) || (u < 0 && v > 0)) {
      const double t = u / (u - v);
      out.push_back({from.x + (to.x - from.x) * t, from.y + (to.y - from.y) * t});
    }
  }
  return out;
}

// Appends the parts of a convex piece that lie outside of a convex opening.
void subtract(const Polygon& piece, const Polygon& opening, double least_area,
              std::vector<Polygon>& out) {
  std::vector<Polygon> parts;
  Polygon rest = piece;
  for (size_t i = 0; i < opening.size() && !rest.empty(); ++i) {
    const Point &a = opening[i], &b = opening[(i + 1) % opening.size()];
    Polygon outside = part_beside(rest, a, b, -1);
    if (area_of(outside) > least_area) parts.push_back(std::move(outside));
    rest = part_beside(rest, a, b, 1);
    if (area_of(rest) <= least_area) rest.clear();
  }
  if (rest.empty())  // they do not overlap: the piece stays whole
    out.push_back(piece);
  else
    out.insert(out.end(), parts.begin(), parts.end());
}

// Convex polygons that cover a polygon, counterclockwise.
std::vector<Polygon> convex_parts(Polygon p) {
  if (area_of(p) < 0) std::reverse(p.begin(), p.end());
  if (is_convex(p)) return {p};
  std::vector<Vec3> points;
  for (const Point& c : p) points.emplace_back(float(c.x - p[0].x), float(c.y - p[0].y), 0.0f);
  std::vector<Triangle> triangles;
  triangulate(points, triangles);
  std::vector<Polygon> out;
  for (const Triangle& t : triangles) {
    Polygon part{p[t[0]], p[t[1]], p[t[2]]};
    if (area_of(part) < 0) std::reverse(part.begin(), part.end());
    out.push_back(std::move(part));
  }
  return out;
}

// The plane of a polygon: x and y axes, and origin.
struct PlaneFrame {
  Vec3d x, y, origin;

  explicit PlaneFrame(const Corners& boundary) : origin(boundary[0]) {
    const Vec3d n = normal_of(boundary);
    x = normalize(cross(std::abs(n.z) < 0.9 ? Vec3d{0, 0, 1} : Vec3d{1, 0, 0}, n));
    y = cross(n, x);
  }
  Polygon to_plane(const Corners& corners) const {
    Polygon out;
    for (const Vec3d& c : corners) out.push_back({dot(c - origin, x), dot(c - origin, y)});
    return out;
  }
  Corners to_space(const Polygon& p) const {
    Corners out;
    for (const Point& c : p) out.push_back(origin + x * c.x + y * c.y);
    return out;
  }
};

}  // namespace

Corners read_hbjson_points(const JsonNode& list, double unit_m, size_t least) {
  if (list.size() < least)
    list.fail("should have at least " + std::to_string(least) + " points, has " +
              std::to_string(list.size()));
  Corners out;
  for (size_t i = 0; i < list.size(); ++i) {
    const std::vector<double> v = list.element(i).as_numbers(3);
    out.push_back(Vec3d{v[0], v[1], v[2]} * unit_m);
  }
  return out;
}

HbjsonFace read_hbjson_face(const JsonNode& geometry, double unit_m) {
  HbjsonFace face;
  face.boundary = read_hbjson_points(geometry.member("boundary"), unit_m, 3);
  const auto holes = geometry.find_value("holes");
  for (size_t i = 0; holes && i < holes->size(); ++i)
    face.holes.push_back(read_hbjson_points(holes->element(i), unit_m, 3));
  return face;
}

Vec3d normal_of(const Corners& p) {
  Vec3d sum;
  for (size_t i = 1; i + 1 < p.size(); ++i) sum += cross(p[i] - p[0], p[i + 1] - p[0]);
  const double l = length(sum);
  return l > 0 ? sum / l : Vec3d{};
}

std::vector<Corners> without_openings(const Corners& boundary,
                                      const std::vector<Corners>& openings) {
  if (openings.empty() || normal_of(boundary) == Vec3d{}) return {boundary};
  constexpr double least_share = 1e-9;  // of the face's area: smaller pieces come from rounding
  const PlaneFrame plane(boundary);
  const Polygon whole = plane.to_plane(boundary);
  const double least_area = least_share * std::abs(area_of(whole));
  std::vector<Polygon> pieces = convex_parts(whole);
  for (const Corners& opening : openings)
    for (const Polygon& part : convex_parts(plane.to_plane(opening))) {
      std::vector<Polygon> left;
      for (const Polygon& piece : pieces) subtract(piece, part, least_area, left);
      pieces = std::move(left);
    }
  std::vector<Corners> out;
  for (const Polygon& piece : pieces) out.push_back(plane.to_space(piece));
  return out;
}

}  // namespace troffer
