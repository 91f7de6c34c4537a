#include "shadow/cut_cells.h"

#include <algorithm>
#include <cmath>

namespace troffer {

namespace {

// Convex polygon in (u,v).
struct Polygon {
  std::array<Vec2d, most_source_corners> v;
  int count = 0;
};

// The part where a u + b v + c >= 0.
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

// The polygon, given in (u,v) of `plane`, in the parallelogram that bounds it.
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

// The unoccluded term for x and a source point, but for what depends on x alone.
double term(const ReceiverHull& hull, const Vec3d& x, const Vec3d& y) {
  const Vec3d d = y - x;
  const double square = length_squared(d);
  if (!(square > 0)) return 1e300;
  const double cosine = hull.is_flat ? std::max(0.0, dot(hull.normal, d)) : std::sqrt(square);
  return cosine / (square * square);
}

// The point of the cell's parallelogram nearest to x; exact where its sides are orthogonal.
Vec3d nearest_point(const Parallelogram& p, const Vec3d& x) {
  const Vec3d d = x - p.origin;
  const double u = std::clamp(dot(d, p.u) / length_squared(p.u), 0.0, 1.0);
  const double v = std::clamp(dot(d - p.u * u, p.v) / length_squared(p.v), 0.0, 1.0);
  return p.origin + p.u * u + p.v * v;
}

// How the term varies over a cell, for some receivers: the hull's corners and its centre.
struct Terms {
  double variation = 1;          // largest value by mean, for the worst of them
  std::array<double, 9> gain{};  // mean times area
};

Terms terms_of(const FlatCell& cell, const ReceiverHull& hull) {
  const Parallelogram& p = cell.plane;
  Terms terms;
  const double area = length(cross(p.u, p.v));
  for (int r = 0; r <= hull.count; ++r) {
    const Vec3d& x = r < hull.count ? hull.corners[size_t(r)] : hull.centre;
    double most = term(hull, x, nearest_point(p, x)), sum = 0;
    for (const Vec3d& y : cell.all_corners()) most = std::max(most, term(hull, x, y));
    for (const double u : {1.0 / 6, 3.0 / 6, 5.0 / 6})
      for (const double v : {1.0 / 6, 3.0 / 6, 5.0 / 6}) {
        const double t = term(hull, x, p.origin + p.u * u + p.v * v);
        sum += t;
        most = std::max(most, t);
      }
    terms.variation = std::max(terms.variation, sum > 0 ? 9 * most / sum : 1e30);
    terms.gain[size_t(r)] = sum / 9 * area;
  }
  return terms;
}

// So far from the receivers that its term varies little.
bool is_far(const FlatCell& cell, const ReceiverHull& hull) {
  const Parallelogram& p = cell.plane;
  double radius = 0;
  for (int i = 0; i < hull.count; ++i)
    radius = std::max(radius, length(hull.corners[size_t(i)] - hull.centre));
  const double size = std::max(length(p.u + p.v), length(p.u - p.v));
  return length(nearest_point(p, hull.centre) - hull.centre) - radius > 1.5 * size;
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
    // Receivers are some ulps below the origins of their rays: their horizon is lower by that.
    const double lowest = hull.lowest - 1e-5 * hull.magnitude;
    const Parallelogram& s = source.plane;
    p = clipped(p, dot(hull.normal, s.u), dot(hull.normal, s.v),
                dot(hull.normal, s.origin) - lowest);
  }
  return cell_of(source.plane, p);
}

bool halve(const FlatCell& cell, FlatCell& first, FlatCell& second) {
  const Polygon p = polygon_of(cell);
  const bool is_u = length_squared(cell.plane.u) >= length_squared(cell.plane.v);
  const double a = is_u ? 1 : 0, b = is_u ? 0 : 1;
  first = cell_of(cell.plane, clipped(p, -a, -b, 0.5));
  second = cell_of(cell.plane, clipped(p, a, b, -0.5));
  return first.corner_count > 0 && second.corner_count > 0;
}

void cut_cells(const FlatCell& cell, const ReceiverHull& hull, const CellLimits& limits,
               std::vector<FlatCell>& out) {
  struct Open {
    FlatCell cell;
    Terms terms;
  };
  std::vector<Open> open{{cell, {}}};
  if (limits.most_share < 1 || !is_far(cell, hull)) open[0].terms = terms_of(cell, hull);
  while (open.size() < limits.most_cells) {
    std::array<double, 9> total{};
    for (const Open& o : open)
      for (size_t r = 0; r < total.size(); ++r) total[r] += o.terms.gain[r];
    // Of the cells that are too large or vary too much, the one that gives most to some receiver.
    double largest = limits.least_share;
    Open* chosen = nullptr;
    for (Open& o : open) {
      double share = 0;
      for (size_t r = 0; r < total.size(); ++r)
        share = std::max(share, total[r] > 0 ? o.terms.gain[r] / total[r] : 0);
      if (o.terms.variation <= limits.variation && share <= limits.most_share) continue;
      if (share <= largest) continue;
      largest = share;
      chosen = &o;
    }
    FlatCell first, second;
    if (chosen == nullptr || !halve(chosen->cell, first, second)) break;
    *chosen = {first, terms_of(first, hull)};
    open.push_back({second, terms_of(second, hull)});
  }
  for (const Open& o : open) out.push_back(o.cell);
}

}  // namespace troffer
