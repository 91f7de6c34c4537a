#include "report/surface.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>
#include <type_traits>
#include <utility>

#include "base/units.h"

namespace troffer {

namespace {

double turn(const Vec2d& a, const Vec2d& b, const Vec2d& p) {
  return (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x);
}

bool is_inside(const PlaneTriangle& t, const Vec2d& p) {
  const double a = turn(t[0], t[1], p), b = turn(t[1], t[2], p), c = turn(t[2], t[0], p);
  return (a >= 0 && b >= 0 && c >= 0) || (a <= 0 && b <= 0 && c <= 0);
}

double distance(const std::array<Vec2d, 2>& edge, const Vec2d& p) {
  const Vec2d way = edge[1] - edge[0], to = p - edge[0];
  const double l = dot(way, way);
  const double t = l > 0 ? std::clamp(dot(to, way) / l, 0.0, 1.0) : 0;
  const Vec2d off = to - way * t;
  return std::sqrt(dot(off, off));
}

bool is_off_rim(const AssessedSurface& s, const Vec2d& p) {
  if (!lies_on(s, p)) return false;
  constexpr double rounding = 1e-6;
  return std::all_of(s.rim.begin(), s.rim.end(), [&](const std::array<Vec2d, 2>& e) {
    return distance(e, p) >= s.border - rounding;
  });
}

// Returns a point that certainly lies on the surface: the middle of the largest triangle.
Vec2d a_middle(const AssessedSurface& s) {
  Vec2d middle{s.width / 2, s.height / 2};
  double most = 0;
  for (const PlaneTriangle& t : s.triangles) {
    const double area = std::abs(turn(t[0], t[1], t[2]));
    if (area <= most) continue;
    most = area;
    middle = (t[0] + t[1] + t[2]) * (1.0 / 3);
  }
  return middle;
}

using Edge = std::pair<std::array<int64_t, 2>, std::array<int64_t, 2>>;

// Returns the edges that belong to one triangle alone. Corners that agree to a tenth of a
// millimetre are the same.
std::vector<std::array<Vec2d, 2>> rim_of(const std::vector<PlaneTriangle>& triangles) {
  const auto key = [](const Vec2d& p) {
    return std::array<int64_t, 2>{std::llround(p.x * 1e4), std::llround(p.y * 1e4)};
  };
  std::map<Edge, std::pair<int, std::array<Vec2d, 2>>> edges;
  for (const PlaneTriangle& t : triangles)
    for (size_t k = 0; k < 3; ++k) {
      const Vec2d &a = t[k], &b = t[(k + 1) % 3];
      const auto ka = key(a), kb = key(b);
      auto& e = edges[ka < kb ? Edge{ka, kb} : Edge{kb, ka}];
      ++e.first;
      e.second = {a, b};
    }
  std::vector<std::array<Vec2d, 2>> rim;
  for (const auto& [k, e] : edges)
    if (e.first == 1) rim.push_back(e.second);
  return rim;
}

// Returns the direction of most of the rim's length. It is turned by quarter turns to lie nearest
// to the world's x, or y if the normal is along x.
Vec3d direction_of(const std::vector<std::array<Vec2d, 2>>& rim, const Vec3d& u, const Vec3d& n) {
  constexpr double steps = 2 * pi / 0.002;              // steps per turn: a tenth of a degree
  std::map<int64_t, std::pair<double, Vec3d>> lengths;  // by direction modulo a quarter turn
  for (const auto& e : rim) {
    const Vec2d way = e[1] - e[0];
    const double l = std::sqrt(dot(way, way));
    if (!(l > 0)) continue;
    const double quarter = std::remainder(std::atan2(way.y, way.x), pi / 2);
    auto& sum = lengths[std::llround(quarter / (2 * pi) * steps)];
    if (l > length(sum.second)) sum.second = u * way.x + cross(n, u) * way.y;
    sum.first += l;
  }
  double most = 0;
  Vec3d along = u;
  for (const auto& [key, sum] : lengths) {
    if (sum.first <= most * 1.0001) continue;
    most = sum.first;
    along = normalize(sum.second);
  }
  const Vec3d wanted = std::abs(n.x) < 0.9 ? Vec3d{1, 0, 0} : Vec3d{0, 1, 0};
  const Vec3d across = cross(n, along);
  Vec3d best = along;
  for (const Vec3d& v : {across, -along, -across})
    if (dot(v, wanted) > dot(best, wanted) + 1e-9) best = v;
  return best;
}

}  // namespace

const char* name_of(SurfaceKind kind) {
  switch (kind) {
    case SurfaceKind::desk:
      return "desk";
    case SurfaceKind::floor:
      return "floor";
    case SurfaceKind::work_plane:
      return "work plane";
    case SurfaceKind::given:
      break;
  }
  return "given";
}

bool lies_on(const AssessedSurface& s, const Vec2d& p) {
  if (!(p.x >= 0 && p.y >= 0 && p.x <= s.width && p.y <= s.height)) return false;
  return s.triangles.empty() ||
         std::any_of(s.triangles.begin(), s.triangles.end(),
                     [&](const PlaneTriangle& t) { return is_inside(t, p); });
}

Vec3d middle_of(const AssessedSurface& s) {
  const Vec2d middle{s.width / 2, s.height / 2};
  return s.place(lies_on(s, middle) ? middle : a_middle(s));
}

SurfaceGrid grid_of(const AssessedSurface& s) {
  SurfaceGrid g;
  const double inset = std::min(s.border, 0.45 * std::min(s.width, s.height));
  const Vec2d size{s.width - 2 * inset, s.height - 2 * inset};
  g.shape = s.spacing > 0 ? grid_of_spacing(size.x, size.y, s.spacing) : grid_shape(size.x, size.y);
  g.first = {inset, inset};
  g.cell = {size.x / g.shape.columns, size.y / g.shape.rows};
  for (int row = 0; row < g.shape.rows; ++row)
    for (int column = 0; column < g.shape.columns; ++column) {
      const Vec2d p = g.first + Vec2d{g.cell.x * (column + 0.5), g.cell.y * (row + 0.5)};
      if (is_off_rim(s, p)) g.points.push_back({column, row, s.place(p)});
    }
  if (!g.points.empty()) return g;
  const Vec2d middle = a_middle(s), from = middle - g.first;
  g.points.push_back({std::clamp(int(from.x / g.cell.x), 0, g.shape.columns - 1),
                      std::clamp(int(from.y / g.cell.y), 0, g.shape.rows - 1), s.place(middle)});
  return g;
}

AssessedSurface surface_of_triangles(const std::vector<std::array<Vec3d, 3>>& triangles,
                                     const Vec3d& n,
                                     const std::vector<std::array<Vec3d, 2>>& known_rim) {
  const Vec3d axis = std::abs(n.x) < 0.9 ? Vec3d{1, 0, 0} : Vec3d{0, 1, 0};
  const Vec3d u = normalize(axis - n * dot(axis, n));
  const Vec3d origin = triangles.front()[0];
  const auto flat = [&](const auto& shapes, const Vec3d& along) {
    std::vector<std::array<Vec2d, std::tuple_size_v<std::decay_t<decltype(shapes[0])>>>> out;
    const Vec3d across = cross(n, along);
    for (const auto& corners : shapes) {
      auto& p = out.emplace_back();
      for (size_t k = 0; k < p.size(); ++k)
        p[k] = {dot(corners[k] - origin, along), dot(corners[k] - origin, across)};
    }
    return out;
  };
  AssessedSurface s;
  s.along = direction_of(known_rim.empty() ? rim_of(flat(triangles, u)) : flat(known_rim, u), u, n);
  s.across = cross(n, s.along);
  s.triangles = flat(triangles, s.along);
  Vec2d lower = s.triangles[0][0], upper = lower;
  for (const PlaneTriangle& t : s.triangles)
    for (const Vec2d& p : t) {
      lower = {std::min(lower.x, p.x), std::min(lower.y, p.y)};
      upper = {std::max(upper.x, p.x), std::max(upper.y, p.y)};
    }
  for (PlaneTriangle& t : s.triangles) {
    for (Vec2d& p : t) p = p - lower;
    s.area += 0.5 * std::abs(turn(t[0], t[1], t[2]));
  }
  s.rim = known_rim.empty() ? rim_of(s.triangles) : flat(known_rim, s.along);
  if (!known_rim.empty())
    for (auto& e : s.rim) e = {e[0] - lower, e[1] - lower};
  s.corner = origin + s.along * lower.x + s.across * lower.y;
  s.width = upper.x - lower.x;
  s.height = upper.y - lower.y;
  return s;
}

}  // namespace troffer
