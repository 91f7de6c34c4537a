#include "import/pbrt/pbrt_curve.h"

#include <algorithm>
#include <cmath>

#include "base/frame.h"
#include "base/units.h"

namespace troffer {

namespace {

constexpr int tube_sides = 6;
constexpr double most_turn_rad = 0.2;  // turn of the curve per cell
constexpr int most_cells = 16;         // per segment

struct PbrtCurve {
  std::vector<std::array<Vec3d, 4>> segments;  // cubic Bézier
  std::vector<Vec3d> normals;                  // at the segment ends; empty for a tube
  double width0 = 1, width1 = 1;
};

std::array<Vec3d, 4> cubic_of_quadratic(const Vec3d& a, const Vec3d& b, const Vec3d& c) {
  return {a, a * (1.0 / 3) + b * (2.0 / 3), b * (2.0 / 3) + c * (1.0 / 3), c};
}

// Segment of the curve from control point `i` on, as a cubic Bézier curve.
std::array<Vec3d, 4> piece(const std::vector<Vec3d>& p, size_t i, size_t degree, bool is_bezier) {
  if (degree == 2) {
    if (is_bezier) return cubic_of_quadratic(p[i], p[i + 1], p[i + 2]);
    return cubic_of_quadratic((p[i] + p[i + 1]) * 0.5, p[i + 1], (p[i + 1] + p[i + 2]) * 0.5);
  }
  if (is_bezier) return {p[i], p[i + 1], p[i + 2], p[i + 3]};
  const Vec3d b = p[i + 1] * (2.0 / 3) + p[i + 2] * (1.0 / 3);
  const Vec3d c = p[i + 1] * (1.0 / 3) + p[i + 2] * (2.0 / 3);
  return {(p[i] + p[i + 1] * 2) * (1.0 / 6) + b * 0.5, b, c,
          c * 0.5 + (p[i + 2] * 2 + p[i + 3]) * (1.0 / 6)};
}

std::vector<Vec3d> control_vectors(const std::vector<double>& numbers) {
  std::vector<Vec3d> out;
  for (size_t i = 0; i + 2 < numbers.size(); i += 3)
    out.push_back({numbers[i], numbers[i + 1], numbers[i + 2]});
  return out;
}

PbrtCurve read_curve(const PbrtParams& params, Vec3d& anchor) {
  const std::string basis = params.get_string("basis", "bezier");
  const std::string type = params.get_string("type", "flat");
  const int degree = params.get_int("degree", 3);
  if (basis != "bezier" && basis != "bspline")
    fail_at(params.place, params.owner + ": \"basis\" should be bezier or bspline");
  if (type != "flat" && type != "cylinder" && type != "ribbon")
    fail_at(params.place, params.owner + ": \"type\" should be flat, cylinder or ribbon");
  if (degree != 2 && degree != 3)
    fail_at(params.place, params.owner + ": \"degree\" should be 2 or 3");
  std::vector<Vec3d> points = control_vectors(params.numbers("P", PbrtType::point3));
  if (!points.empty()) anchor = points[0];
  for (Vec3d& p : points) p -= anchor;
  const auto d = size_t(degree), n = points.size();
  const bool is_bezier = basis == "bezier";
  if (n < d + 1 || (is_bezier && (n - 1) % d != 0))
    fail_at(params.place, params.owner + ": that number of points makes no curve");
  PbrtCurve curve;
  const size_t step = is_bezier ? d : 1;
  for (size_t i = 0; i + d < n; i += step) curve.segments.push_back(piece(points, i, d, is_bezier));
  const double width = params.get_float("width", 1);
  curve.width0 = params.get_float("width0", width);
  curve.width1 = params.get_float("width1", width);
  curve.normals = control_vectors(params.numbers("N", PbrtType::normal));
  if (type != "ribbon") curve.normals.clear();
  if (type == "ribbon" && curve.normals.size() != curve.segments.size() + 1)
    fail_at(params.place, params.owner + ": a ribbon has one normal more than segments");
  params.ignore({"splitdepth"});
  return curve;
}

struct CurvePoint {
  Vec3d position, tangent;
};

CurvePoint at(const std::array<Vec3d, 4>& s, double t) {
  const double r = 1 - t;
  const Vec3d velocity =
      (s[1] - s[0]) * (r * r) + (s[2] - s[1]) * (2 * r * t) + (s[3] - s[2]) * (t * t);
  const double speed = length(velocity);
  const Vec3d chord = s[3] - s[0];
  const double size = length(chord);
  return {s[0] * (r * r * r) + s[1] * (3 * r * r * t) + s[2] * (3 * r * t * t) + s[3] * (t * t * t),
          speed > 1e-12 * size ? velocity / speed
          : size > 0           ? chord / size
                               : Vec3d{0, 0, 1}};
}

// Number of cells along a segment, from the total turn of its control polygon.
int cells_of(const std::array<Vec3d, 4>& s) {
  double turn = 0;
  Vec3d last;
  for (size_t i = 0; i < 3; ++i) {
    const Vec3d edge = s[i + 1] - s[i];
    const double size = length(edge);
    if (!(size > 0)) continue;
    const Vec3d direction = edge / size;
    if (length_squared(last) > 0) turn += std::acos(std::clamp(dot(last, direction), -1.0, 1.0));
    last = direction;
  }
  return std::clamp(int(std::ceil(turn / most_turn_rad)), 1, most_cells);
}

// One ring of a tube, or two opposite points of a ribbon.
struct Rung {
  CurvePoint point;
  Vec3d side;  // perpendicular to the tangent; the normal of a ribbon
  double width = 0, v = 0;
};

void append_rung(Mesh& mesh, const Rung& r, bool is_strip) {
  const Vec3d other = cross(r.point.tangent, r.side);
  const auto add = [&](const Vec3d& p, const Vec3d& normal, double u) {
    mesh.positions.emplace_back(p);
    mesh.normals.emplace_back(normal);
    mesh.uvs.push_back({float(u), float(r.v)});
  };
  if (is_strip) {
    add(r.point.position - other * (r.width / 2), r.side, 0);
    add(r.point.position + other * (r.width / 2), r.side, 1);
    return;
  }
  // The mean projected width of a convex prism is its perimeter divided by pi.
  const double radius = r.width / 2 * pi / (tube_sides * std::sin(pi / tube_sides));
  for (int k = 0; k <= tube_sides; ++k) {
    const double phi = 2 * pi * (k % tube_sides) / tube_sides;
    const Vec3d out = r.side * std::cos(phi) + other * std::sin(phi);
    add(r.point.position + out * radius, out, double(k) / tube_sides);
  }
}

// Unit vector perpendicular to the tangent and as close to `wanted` as possible.
Vec3d side_of(const Vec3d& tangent, const Vec3d& wanted) {
  const Vec3d flat = wanted - tangent * dot(wanted, tangent);
  const double size = length(flat);
  return size > 1e-9 ? flat / size : Framed(tangent).tangent;
}

}  // namespace

AnchoredMesh read_pbrt_curve(const PbrtParams& params, size_t max_triangles, WarningLog& warnings) {
  AnchoredMesh made;
  const PbrtCurve curve = read_curve(params, made.anchor);
  const bool is_strip = !curve.normals.empty();
  const size_t across = is_strip ? 1 : tube_sides, n = curve.segments.size();
  if (n > max_triangles / (2 * across * most_cells)) fail_at(params.place, "too many triangles");
  if (!is_strip && params.get_string("type", "flat") == "flat")
    warnings.add("flat curves, which turn to the viewer, are shown as tubes");
  Mesh& mesh = made.mesh;
  Vec3d side;
  size_t rungs = 0;
  for (size_t i = 0; i < n; ++i) {
    const int cells = cells_of(curve.segments[i]);
    for (int k = i == 0 ? 0 : 1; k <= cells; ++k) {
      const double t = double(k) / cells;
      Rung r;
      r.point = at(curve.segments[i], t);
      r.v = (double(i) + t) / double(n);
      r.width = curve.width0 + (curve.width1 - curve.width0) * r.v;
      // A tube carries its side vector along, so that it does not twist.
      r.side = side = side_of(
          r.point.tangent, is_strip ? curve.normals[i] * (1 - t) + curve.normals[i + 1] * t : side);
      append_rung(mesh, r, is_strip);
      ++rungs;
    }
  }
  const auto stride = uint32_t(across + 1);
  for (uint32_t i = 0; i + 1 < rungs; ++i)
    for (uint32_t k = 0; k < across; ++k) {
      const uint32_t a = i * stride + k, b = a + 1, c = a + stride, d = c + 1;
      mesh.triangles.push_back({a, b, d});
      mesh.triangles.push_back({a, d, c});
    }
  return made;
}

}  // namespace troffer
