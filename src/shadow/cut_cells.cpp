#include "shadow/cut_cells.h"

#include <algorithm>
#include <cmath>

#include "light/irradiance.h"

namespace troffer {

namespace {

// A convex polygon in (u,v).
struct Polygon {
  std::array<Vec2d, most_source_corners> v;
  int count = 0;
};

// Returns the part of p with a u + b v + c >= 0.
Polygon clipped(const Polygon& p, double a, double b, double c) {
  Polygon out;
  const auto add = [&](const Vec2d& q) {
    if (out.count < int(most_source_corners)) out.v[size_t(out.count++)] = q;
  };
  for (int i = 0; i < p.count; ++i) {
    const Vec2d &q = p.v[size_t(i)], &r = p.v[size_t((i + 1) % p.count)];
    const double hq = a * q.x + b * q.y + c, hr = a * r.x + b * r.y + c;
    if (hq >= 0) add(q);
    if ((hq < 0) != (hr < 0)) add(q + (r - q) * (hq / (hq - hr)));
  }
  return out;
}

double area(const Polygon& p) {
  double twice = 0;
  for (int i = 1; i + 1 < p.count; ++i) {
    const Vec2d e = p.v[size_t(i)] - p.v[0], f = p.v[size_t(i) + 1] - p.v[0];
    twice += e.x * f.y - e.y * f.x;
  }
  return std::abs(twice) / 2;
}

Polygon polygon_of(const FlatCell& cell) {
  Polygon p;
  if (cell.count == 0) {
    p.count = 4;
    p.v[0] = {0, 0};
    p.v[1] = {1, 0};
    p.v[2] = {1, 1};
    p.v[3] = {0, 1};
  } else {
    p.count = cell.count;
    for (int i = 0; i < cell.count; ++i) p.v[size_t(i)] = Vec2d(cell.outline[size_t(i)]);
  }
  return p;
}

// Returns the polygon, given in (u,v) of `plane`, as a cell with the parallelogram that bounds it.
// The cell has no corners if the polygon has hardly any area.
FlatCell cell_of(const Parallelogram& plane, const Polygon& p) {
  FlatCell cell;
  if (p.count < 3) return cell;
  Vec2d lower = p.v[0], upper = p.v[0];
  for (int i = 1; i < p.count; ++i) {
    const Vec2d& v = p.v[size_t(i)];
    lower = {std::min(lower.x, v.x), std::min(lower.y, v.y)};
    upper = {std::max(upper.x, v.x), std::max(upper.y, v.y)};
  }
  const Vec2d size = upper - lower;
  if (!(size.x > 1e-9) || !(size.y > 1e-9)) return cell;
  if (!(area(p) > 1e-6 * size.x * size.y)) return cell;
  cell.plane = {plane.origin + plane.u * lower.x + plane.v * lower.y, plane.u * size.x,
                plane.v * size.y, plane.normal};
  cell.corner_count = p.count;
  for (int i = 0; i < p.count; ++i) {
    const Vec2d& v = p.v[size_t(i)];
    cell.corners[size_t(i)] = plane.origin + plane.u * v.x + plane.v * v.y;
    cell.outline[size_t(i)] = Vec2(Vec2d{(v.x - lower.x) / size.x, (v.y - lower.y) / size.y});
  }
  const bool is_whole = p.count == 4 && area(p) > (1 - 1e-9) * size.x * size.y;
  cell.count = is_whole ? 0 : p.count;
  return cell;
}

// The unoccluded term (over pi) of one receiver as a function of the point y in the source's plane.
// With d = y - x and h the receiver's height over the plane, it is cos cos / r² = h n·d / r⁴ for
// receivers of a flat hull. For receivers that may face anywhere it is h / r³.
class Term {
 public:
  Term(const ReceiverHull& hull, const Vec3d& x, const Vec3d& plane_normal, const Vec3d& in_plane)
      : x_(x),
        normal_(hull.normal),
        plane_(plane_normal),
        height_(dot(plane_normal, x - in_plane)),
        is_flat_(hull.is_flat) {}

  bool is_lit() const { return height_ > 0; }
  double at(const Vec3d& y) const {
    const Vec3d d = y - x_;
    const double square = length_squared(d);
    if (!(square > 0)) return 0;
    if (!is_flat_) return height_ / (square * std::sqrt(square));
    return height_ * std::max(0.0, dot(normal_, d)) / (square * square);
  }
  // Returns the point of the plane where the term is largest. It lies on the line of steepest n·d =
  // c + m s from the receiver's foot, where (c + m s) / (s² + h²)² is stationary: 3 m s² + 4 c s =
  // m h².
  Vec3d peak() const {
    const Vec3d foot = x_ - plane_ * height_;
    if (!is_flat_) return foot;
    const Vec3d slope = normal_ - plane_ * dot(normal_, plane_);
    const double m = length(slope), c = dot(normal_, foot - x_);
    const double root = std::sqrt(4 * c * c + 3 * m * m * height_ * height_);
    // the larger root, without cancellation
    const double below = c > 0 ? 2 * c + root : 0;
    const double s = c > 0 ? m * height_ * height_ / below : (m > 0 ? (root - 2 * c) / (3 * m) : 0);
    return m > 0 ? foot + slope * (s / m) : foot;
  }
  // Returns the largest value on the segment from p to q. With n·d = a s + b and |d|² = A s² + B s
  // + C, the term is stationary at 3 a A s² + (a B + 4 b A) s = a C - 2 b B.
  double most_along(const Vec3d& p, const Vec3d& q) const {
    const Vec3d e = q - p, d = p - x_;
    const double A = length_squared(e), B = 2 * dot(d, e), C = length_squared(d);
    double most = std::max(at(p), at(q));
    const auto look = [&](double s) {
      if (s > 0 && s < 1) most = std::max(most, at(p + e * s));
    };
    if (!is_flat_) {
      look(-B / (2 * A));
      return most;
    }
    const double a = dot(normal_, e), b = dot(normal_, d);
    const double two = 3 * a * A, one = a * B + 4 * b * A, zero = 2 * b * B - a * C;
    const double root = std::sqrt(std::max(one * one - 4 * two * zero, 0.0));
    const double large = -0.5 * (one + std::copysign(root, one));
    look(large / two);
    look(zero / large);
    return most;
  }

 private:
  Vec3d x_, normal_, plane_;
  double height_;
  bool is_flat_;
};

// Returns the solid angle of a convex polygon as seen from x.
double solid_angle(std::span<const Vec3d> corners, const Vec3d& x) {
  double sum = 0;
  const Vec3d a = corners[0] - x;
  const double ra = length(a);
  for (size_t i = 1; i + 1 < corners.size(); ++i) {
    const Vec3d b = corners[i] - x, c = corners[i + 1] - x;
    const double rb = length(b), rc = length(c);
    const double volume = std::abs(dot(a, cross(b - a, c - a)));
    sum += 2 * std::atan2(volume, ra * rb * rc + dot(a, b) * rc + dot(a, c) * rb + dot(b, c) * ra);
  }
  return sum;
}

// True if a point of the plane lies in the convex cell.
bool holds(const FlatCell& cell, const Vec3d& y) {
  int left = 0, right = 0;
  const std::span<const Vec3d> c = cell.all_corners();
  for (size_t i = 0; i < c.size(); ++i) {
    const double side = dot(cell.plane.normal, cross(c[(i + 1) % c.size()] - c[i], y - c[i]));
    left += side > 0;
    right += side < 0;
  }
  return left == 0 || right == 0;
}

double area_of(std::span<const Vec3d> corners) {
  Vec3d twice;
  for (size_t i = 1; i + 1 < corners.size(); ++i)
    twice += cross(corners[i] - corners[0], corners[i + 1] - corners[0]);
  return length(twice) / 2;
}

// Variation of the term over a cell, for the corners and the centre of the hull.
struct Terms {
  double variation = 1;          // largest value over mean, for the worst receiver
  std::array<double, 9> gain{};  // exact form factor of the cell per receiver
};

Terms terms_of(const FlatCell& cell, const ReceiverHull& hull) {
  Terms terms;
  const std::span<const Vec3d> corners = cell.all_corners();
  const double area = area_of(corners);
  for (int r = 0; r <= hull.count; ++r) {
    const Vec3d& x = r < hull.count ? hull.corners[size_t(r)] : hull.centre;
    const Term term(hull, x, cell.plane.normal, cell.plane.origin);
    if (!term.is_lit()) continue;
    const double gain = hull.is_flat ? polygon_irradiance(corners, x, hull.normal, Sides::both)
                                     : solid_angle(corners, x);
    terms.gain[size_t(r)] = gain;
    if (!(gain > 0)) continue;
    const Vec3d peak = term.peak();
    double most = holds(cell, peak) ? term.at(peak) : 0;
    for (size_t i = 0; i < corners.size(); ++i)
      most = std::max(most, term.most_along(corners[i], corners[(i + 1) % corners.size()]));
    terms.variation = std::max(terms.variation, most * area / gain);
  }
  return terms;
}

// Returns the point of the cell's parallelogram nearest to x. It is exact if the sides are
// orthogonal.
Vec3d nearest_point(const Parallelogram& p, const Vec3d& x) {
  const Vec3d d = x - p.origin;
  const double u = std::clamp(dot(d, p.u) / length_squared(p.u), 0.0, 1.0);
  const double v = std::clamp(dot(d - p.u * u, p.v) / length_squared(p.v), 0.0, 1.0);
  return p.origin + p.u * u + p.v * v;
}

// True if the cell is so far from the receivers that its term varies little.
bool is_far(const FlatCell& cell, const ReceiverHull& hull) {
  const Parallelogram& p = cell.plane;
  const double size = std::max(length(p.u + p.v), length(p.u - p.v));
  return length(nearest_point(p, hull.centre) - hull.centre) - hull.radius() > 1.5 * size;
}

}  // namespace

FlatCell visible_part(const FlatSource& source, const ReceiverHull& hull) {
  Polygon p;
  if (source.outline.empty()) {
    p = polygon_of(FlatCell());
  } else {
    for (const Vec2& v : source.outline)
      if (p.count < int(most_outline_corners)) p.v[size_t(p.count++)] = Vec2d(v);
  }
  if (hull.is_flat && !source.is_disk) {
    // Receivers lie some ulps below the origins of their rays, so their horizon is lowered by that.
    const double lowest = hull.lowest - 1e-5 * hull.magnitude;
    const Parallelogram& s = source.plane;
    p = clipped(p, dot(hull.normal, s.u), dot(hull.normal, s.v),
                dot(hull.normal, s.origin) - lowest);
  }
  FlatCell cell = cell_of(source.plane, p);
  cell.is_disk = source.is_disk;
  return cell;
}

bool halve(const FlatCell& cell, FlatCell& first, FlatCell& second) {
  const Polygon p = polygon_of(cell);
  const bool is_u = length_squared(cell.plane.u) >= length_squared(cell.plane.v);
  const double a = is_u ? 1 : 0, b = is_u ? 0 : 1;
  first = cell_of(cell.plane, clipped(p, -a, -b, 0.5));
  second = cell_of(cell.plane, clipped(p, a, b, -0.5));
  return first.corner_count > 0 && second.corner_count > 0;
}

namespace {

// Returns a quarter of a disk as a polygon of its centre and an arc of chords. The chords' ends lie
// slightly outside the circle, so that the polygon has the quarter's exact area.
FlatCell quarter(const FlatCell& disk, int which) {
  constexpr int chords = 9;
  constexpr double step = 0.5 * pi / chords;
  const double radius = 0.5 * std::sqrt(step / std::sin(step));
  Polygon p;
  p.v[0] = {0.5, 0.5};
  for (int i = 0; i <= chords; ++i) {
    const double angle = 0.5 * pi * which + step * i;
    p.v[size_t(i) + 1] = Vec2d{0.5, 0.5} + Vec2d{std::cos(angle), std::sin(angle)} * radius;
  }
  p.count = chords + 2;
  return cell_of(disk.plane, p);
}

// A leaf of the bintree over a source.
struct Leaf {
  FlatCell cell;
  Terms terms;
  bool is_final = false;  // cannot be halved
};

// Splits a leaf: its first part replaces it, the others are appended.
void split(size_t leaf, const ReceiverHull& hull, std::vector<Leaf>& leaves) {
  const FlatCell whole = leaves[leaf].cell;
  if (whole.is_disk) {
    for (int i = 0; i < 4; ++i) {
      const FlatCell part = quarter(whole, i);
      const Leaf l{part, terms_of(part, hull)};
      if (i == 0)
        leaves[leaf] = l;
      else
        leaves.push_back(l);
    }
    return;
  }
  FlatCell first, second;
  if (!halve(whole, first, second)) {
    leaves[leaf].is_final = true;
    return;
  }
  leaves[leaf] = {first, terms_of(first, hull)};
  leaves.push_back({second, terms_of(second, hull)});
}

}  // namespace

void cut_cells(const FlatCell& cell, const ReceiverHull& hull, const CellLimits& limits,
               std::vector<FlatCell>& out) {
  if (limits.most_share >= 1 && is_far(cell, hull)) {
    out.push_back(cell);
    return;
  }
  std::vector<Leaf> leaves{{cell, terms_of(cell, hull)}};
  const Terms whole = leaves[0].terms;
  const auto is_too_large = [&](const Leaf& l) {
    double share = 0;
    for (size_t r = 0; r < whole.gain.size(); ++r)
      share = std::max(share, whole.gain[r] > 0 ? l.terms.gain[r] / whole.gain[r] : 0);
    return share > limits.most_share ||
           (l.terms.variation > limits.variation && share > limits.least_share);
  };
  // The loop ends because each split cell holds more than a fixed share of the exact form factor.
  for (size_t i = 0; i < leaves.size(); ++i)
    while (!leaves[i].is_final && is_too_large(leaves[i])) split(i, hull, leaves);
  for (const Leaf& l : leaves) out.push_back(l.cell);
}

}  // namespace troffer
