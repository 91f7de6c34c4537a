#include "bake/charts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "bake/flat_triangles.h"
#include "base/frame.h"
#include "base/units.h"

namespace troffer {

namespace {

constexpr double least_cosine = 0.766;  // cosine of 40 degrees, the largest angle to a chart's
                                        // normal
constexpr float least_smooth = 0.7f;  // least cosine between two normals at one corner; below it is
                                      // a crease
// A limit on a chart's triangles: the search for overlaps is slow if many share a cell.
constexpr size_t most_triangles = 8192;
constexpr uint32_t none = 0xffffffffu;

// Triangles with their normals, and their neighbours across edges.
struct ChartSurface {
  std::vector<Vec3d> normals;                   // unit; 0 for degenerate triangles
  std::vector<double> areas;                    // m²
  std::vector<std::array<uint32_t, 3>> beside;  // triangle across edge k, from corner k to the
                                                // next; or none
};

// Returns vertex numbers that are equal where positions are equal.
std::vector<uint32_t> welded(const std::vector<Vec3>& positions) {
  std::vector<uint32_t> order(positions.size()), number(positions.size());
  std::iota(order.begin(), order.end(), 0u);
  const auto key = [&](uint32_t i) {
    const Vec3& p = positions[i];
    return std::array<float, 3>{p.x, p.y, p.z};
  };
  const auto is_sound = [&](uint32_t i) { return is_finite(positions[i]); };
  std::sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) {
    if (!is_sound(a) || !is_sound(b)) return is_sound(a) != is_sound(b) ? is_sound(a) : a < b;
    const auto ka = key(a), kb = key(b);
    return ka != kb ? ka < kb : a < b;
  });
  for (size_t i = 0; i < order.size(); ++i) {
    const bool is_same = i > 0 && is_sound(order[i]) && key(order[i]) == key(order[i - 1]);
    number[order[i]] = is_same ? number[order[i - 1]] : order[i];
  }
  return number;
}

struct Edge {
  uint32_t low, high;  // welded corners
  uint32_t triangle, side;
  bool is_up;  // the triangle passes the edge from low to high
};

bool is_smooth(const Mesh& mesh, const Edge& a, const Edge& b) {
  if (mesh.normals.empty()) return true;
  const auto normal = [&](const Edge& e, bool at_low) {
    const Triangle& t = mesh.triangles[e.triangle];
    return mesh.normals[t[at_low == e.is_up ? e.side : (e.side + 1) % 3]];
  };
  return dot(normal(a, true), normal(b, true)) > least_smooth &&
         dot(normal(a, false), normal(b, false)) > least_smooth;
}

void join_edges(const Mesh& mesh, const std::vector<uint32_t>& weld, ChartSurface& s) {
  std::vector<Edge> edges;
  for (uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    if (s.areas[t] <= 0) continue;
    for (uint32_t k = 0; k < 3; ++k) {
      const uint32_t a = weld[mesh.triangles[t][k]], b = weld[mesh.triangles[t][(k + 1) % 3]];
      edges.push_back({std::min(a, b), std::max(a, b), t, k, a < b});
    }
  }
  std::sort(edges.begin(), edges.end(), [](const Edge& a, const Edge& b) {
    return std::tie(a.low, a.high, a.triangle, a.side) <
           std::tie(b.low, b.high, b.triangle, b.side);
  });
  for (size_t i = 0; i < edges.size();) {
    size_t end = i + 1;
    while (end < edges.size() && edges[end].low == edges[i].low && edges[end].high == edges[i].high)
      ++end;
    // If more than two triangles meet, or two that face opposite ways, continuity is undefined.
    const Edge &a = edges[i], &b = edges[end - 1];
    if (end - i == 2 && a.is_up != b.is_up && is_smooth(mesh, a, b)) {
      s.beside[a.triangle][a.side] = b.triangle;
      s.beside[b.triangle][b.side] = a.triangle;
    }
    i = end;
  }
}

ChartSurface surface_of(const Mesh& mesh) {
  ChartSurface s;
  const size_t n = mesh.triangles.size();
  s.normals.assign(n, Vec3d{});
  s.areas.assign(n, 0);
  s.beside.assign(n, {none, none, none});
  for (size_t t = 0; t < n; ++t) {
    const auto& [a, b, c] = mesh.triangles[t];
    const Vec3d p(mesh.positions[a]), q(mesh.positions[b]), r(mesh.positions[c]);
    const Vec3d doubled = cross(q - p, r - p);
    const double size = length(doubled);
    if (!(size > 1e-30) || !std::isfinite(size)) continue;
    s.normals[t] = doubled / size;
    s.areas[t] = size / 2;
  }
  join_edges(mesh, welded(mesh.positions), s);
  return s;
}

// Coordinates in the plane of a chart.
struct ChartPlane {
  Vec3d origin, x, y;
  ChartPlane(const Vec3d& at, const Vec3d& normal) : origin(at) {
    const Frame frame{Vec3(normal)};
    x = Vec3d(frame.tangent);
    x = normalize(x - normal * dot(x, normal));
    y = cross(normal, x);
  }
  Vec2d of(const Vec3& p) const {
    const Vec3d d = Vec3d(p) - origin;
    return {dot(d, x), dot(d, y)};
  }
  FlatTriangle of(const Mesh& mesh, const Triangle& t) const {
    return {of(mesh.positions[t[0]]), of(mesh.positions[t[1]]), of(mesh.positions[t[2]])};
  }
};

// Returns the triangles of the chart that grows from `seed`, without triangles of other charts.
std::vector<uint32_t> grown(const Mesh& mesh, const ChartSurface& s, uint32_t seed,
                            const ChartPlane& plane, std::vector<uint8_t>& is_taken) {
  std::vector<uint32_t> chart{seed};
  is_taken[seed] = 1;
  LaidTriangles laid(std::sqrt(2 * s.areas[seed]) / 2);
  laid.add(plane.of(mesh, mesh.triangles[seed]));
  for (size_t next = 0; next < chart.size() && chart.size() < most_triangles; ++next) {
    for (const uint32_t t : s.beside[chart[next]]) {
      if (t == none || is_taken[t] || dot(s.normals[t], s.normals[seed]) < least_cosine) continue;
      if (!laid.add(plane.of(mesh, mesh.triangles[t]))) continue;
      is_taken[t] = 1;
      chart.push_back(t);
    }
  }
  return chart;
}

double turn(const Vec2d& a, const Vec2d& b, const Vec2d& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

// Corners of the convex hull, counterclockwise (monotone chain).
std::vector<Vec2d> hull_of(std::vector<Vec2d> points) {
  std::sort(points.begin(), points.end(),
            [](const Vec2d& a, const Vec2d& b) { return a.x < b.x || (a.x == b.x && a.y < b.y); });
  std::vector<Vec2d> hull;
  for (int pass = 0; pass < 2; ++pass) {
    const size_t first = hull.size();
    for (const Vec2d& p : points) {
      while (hull.size() >= first + 2 && turn(hull[hull.size() - 2], hull.back(), p) <= 0)
        hull.pop_back();
      hull.push_back(p);
    }
    hull.pop_back();
    std::reverse(points.begin(), points.end());
  }
  return hull;
}

// Returns the direction of the longer side of the smallest rectangle around points. The rectangle
// has a side along an edge of the hull [2]; only the longest edges are tried.
Vec2d side_of_rectangle(const std::vector<Vec2d>& points) {
  constexpr size_t most_edges = 48;
  const std::vector<Vec2d> hull = hull_of(points);
  std::vector<Vec2d> ways;
  for (size_t i = 0; i < hull.size(); ++i) ways.push_back(hull[(i + 1) % hull.size()] - hull[i]);
  const auto size = [](const Vec2d& v) { return v.x * v.x + v.y * v.y; };
  std::stable_sort(ways.begin(), ways.end(),
                   [&](const Vec2d& a, const Vec2d& b) { return size(a) > size(b); });
  ways.resize(std::min(ways.size(), most_edges));
  Vec2d best{1, 0};
  double least = 1e300;
  for (const Vec2d& way : ways) {
    if (!(size(way) > 0)) continue;
    const Vec2d x = way * (1 / std::sqrt(size(way)));
    double x0 = 1e300, x1 = -1e300, y0 = 1e300, y1 = -1e300;
    for (const Vec2d& p : hull) {
      const double u = p.x * x.x + p.y * x.y, v = p.y * x.x - p.x * x.y;
      x0 = std::min(x0, u), x1 = std::max(x1, u), y0 = std::min(y0, v), y1 = std::max(y1, v);
    }
    const double area = (x1 - x0) * (y1 - y0);
    if (area >= least * (1 - 1e-9)) continue;
    least = area;
    best = x1 - x0 >= y1 - y0 ? x : Vec2d{-x.y, x.x};  // the longer side along x
  }
  return best;
}

// Copies the vertices of a mesh, once for each group of triangles that uses them.
class Vertices {
 public:
  Vertices(const Mesh& from, ChartedMesh& out) : from_(from), out_(out) {
    out.mesh.name = from.name;
    out.mesh.material = from.material;
    out.mesh.triangles.resize(from.triangles.size());
    copy_.resize(from.positions.size());
    group_.assign(from.positions.size(), none);
  }
  // The copies get place(vertex) as their position in the chart.
  template <class Place>
  void add(uint32_t group, const std::vector<uint32_t>& triangles, const Place& place) {
    for (const uint32_t t : triangles)
      for (size_t k = 0; k < 3; ++k) {
        const uint32_t v = from_.triangles[t][k];
        if (group_[v] != group) {
          group_[v] = group;
          copy_[v] = uint32_t(out_.mesh.positions.size());
          copy(v);
          out_.places.push_back(place(v));
        }
        out_.mesh.triangles[t][k] = copy_[v];
      }
  }

 private:
  void copy(uint32_t v) {
    Mesh& m = out_.mesh;
    m.positions.push_back(from_.positions[v]);
    if (!from_.normals.empty()) m.normals.push_back(from_.normals[v]);
    if (!from_.uvs.empty()) m.uvs.push_back(from_.uvs[v]);
    if (!from_.uvs_2.empty()) m.uvs_2.push_back(from_.uvs_2[v]);
  }
  const Mesh& from_;
  ChartedMesh& out_;
  std::vector<uint32_t> copy_, group_;
};

void lay_out(const Mesh& mesh, const ChartPlane& plane, std::vector<uint32_t> triangles,
             Vertices& vertices, ChartedMesh& out) {
  std::vector<Vec2d> points;
  for (const uint32_t t : triangles)
    for (const Vec2d& p : plane.of(mesh, mesh.triangles[t])) points.push_back(p);
  const Vec2d x = side_of_rectangle(points);
  const auto turned = [&](const Vec2d& p) {
    return Vec2d{p.x * x.x + p.y * x.y, p.y * x.x - p.x * x.y};
  };
  Vec2d lower = turned(points[0]), upper = lower;
  for (const Vec2d& p : points) {
    const Vec2d q = turned(p);
    lower = {std::min(lower.x, q.x), std::min(lower.y, q.y)};
    upper = {std::max(upper.x, q.x), std::max(upper.y, q.y)};
  }
  vertices.add(uint32_t(out.charts.size()), triangles,
               [&](uint32_t v) { return Vec2(turned(plane.of(mesh.positions[v])) - lower); });
  out.charts.push_back({std::move(triangles), Vec2(upper - lower)});
}

// Adds the triangles that belong to no chart.
void add_rest(const std::vector<uint32_t>& rest, Vertices& vertices, ChartedMesh& out) {
  vertices.add(none - 1, rest, [](uint32_t) { return Vec2{0, 0}; });
  out.degenerate = rest.size();
}

}  // namespace

ChartedMesh charted(const Mesh& mesh) {
  ChartedMesh out;
  const ChartSurface s = surface_of(mesh);
  Vertices vertices(mesh, out);
  std::vector<uint32_t> seeds, rest;
  for (uint32_t t = 0; t < mesh.triangles.size(); ++t) (s.areas[t] > 0 ? seeds : rest).push_back(t);
  std::stable_sort(seeds.begin(), seeds.end(),
                   [&](uint32_t a, uint32_t b) { return s.areas[a] > s.areas[b]; });
  std::vector<uint8_t> is_taken(mesh.triangles.size(), 0);
  for (const uint32_t seed : seeds) {
    if (is_taken[seed]) continue;
    const ChartPlane plane(Vec3d(mesh.positions[mesh.triangles[seed][0]]), s.normals[seed]);
    lay_out(mesh, plane, grown(mesh, s, seed, plane, is_taken), vertices, out);
  }
  add_rest(rest, vertices, out);
  return out;
}

bool chart_of_uvs(const Mesh& mesh, const std::vector<Vec2>& uvs, ChartedMesh& out) {
  const ChartSurface s = surface_of(mesh);
  std::vector<uint32_t> all, rest;
  double area = 0, flat_area = 0;
  Vec2d lower{1, 1}, upper{0, 0};
  for (uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    (s.areas[t] > 0 ? all : rest).push_back(t);
    if (!(s.areas[t] > 0)) continue;
    FlatTriangle flat;
    for (size_t k = 0; k < 3; ++k) {
      const Vec2& p = uvs[mesh.triangles[t][k]];
      if (!(p.x >= 0 && p.x <= 1 && p.y >= 0 && p.y <= 1)) return false;
      flat[k] = Vec2d(p);
      lower = {std::min(lower.x, flat[k].x), std::min(lower.y, flat[k].y)};
      upper = {std::max(upper.x, flat[k].x), std::max(upper.y, flat[k].y)};
    }
    area += s.areas[t];
    flat_area += std::abs(doubled_area(flat)) / 2;
    if (!(std::abs(doubled_area(flat)) > 1e-12)) return false;
  }
  if (all.empty()) return false;
  LaidTriangles laid(2 * std::sqrt(flat_area / double(all.size())));
  for (const uint32_t t : all) {
    const auto& [a, b, c] = mesh.triangles[t];
    if (!laid.add({Vec2d(uvs[a]), Vec2d(uvs[b]), Vec2d(uvs[c])})) return false;
  }
  const double scale = std::sqrt(area / flat_area);
  out = {};
  Vertices vertices(mesh, out);
  vertices.add(0, all, [&](uint32_t v) { return Vec2((Vec2d(uvs[v]) - lower) * scale); });
  out.charts.push_back({all, Vec2((upper - lower) * scale)});
  add_rest(rest, vertices, out);
  return true;
}

}  // namespace troffer
