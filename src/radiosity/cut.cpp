// Cuts triangles into sheets, elements and fragments (meshing.h).
#include <algorithm>
#include <cmath>

#include "base/frame.h"
#include "radiosity/meshing_parts.h"
#include "trace/surface.h"

namespace troffer {

namespace {

constexpr uint32_t no_sheet = 0xffffffffu;
constexpr int max_depth = 60;  // limit on bisections; every second one at least halves the edges

using Corners = std::array<uint32_t, 3>;

class Cutter {
 public:
  Cutter(const Scene& scene, const JoinPlan& plan, RadiosityMesh& mesh)
      : plan_(plan), mesh_(mesh), subdivider_(scene, mesh.geometry) {
    element_sheet_.resize(plan.elements.count, no_sheet);
    sheet_pieces_.resize(plan.sheets.count);
    sheet_surface_.resize(plan.sheets.count, 0);
  }

  void cut(uint32_t triangle) {
    const BaseTriangle t = mesh_.geometry.triangles[triangle];
    surface_ = t.surface;
    is_round_ = mesh_.geometry.surfaces[surface_].bulge != Bulge::none;
    joined_element_ = plan_.elements.label[triangle];
    const uint32_t sheet = plan_.sheets.label[triangle];
    if (sheet != no_cluster) begin_piece(sheet, t.vertices);
    mesh_.roots[triangle] = cut(t.vertices, sheet, 0);
  }

  std::vector<uint32_t>& element_sheet() { return element_sheet_; }
  std::vector<std::vector<Corners>>& sheet_pieces() { return sheet_pieces_; }
  std::vector<uint32_t>& sheet_surface() { return sheet_surface_; }

 private:
  // Round surfaces shoot from their fragments, flat ones from the largest possible pieces.
  void begin_piece(uint32_t sheet, const Corners& corners) {
    if (!is_round_) sheet_pieces_[sheet].push_back(corners);
    sheet_surface_[sheet] = surface_;
  }

  int32_t cut(const Corners& corners, uint32_t sheet, int depth) {
    uint8_t edge = 0;
    const float longest = subdivider_.longest_edge(corners, edge);
    if (sheet == no_sheet && (!(longest > plan_.patch_size) || depth >= max_depth)) {
      sheet = uint32_t(sheet_pieces_.size());
      sheet_pieces_.emplace_back();
      sheet_surface_.push_back(surface_);
      begin_piece(sheet, corners);
    }
    if (!(longest > plan_.element_size) || depth >= max_depth) return leaf(corners, sheet);
    const auto halves = subdivider_.split(surface_, corners, edge);
    const auto node = int32_t(mesh_.nodes.size());
    mesh_.nodes.push_back({{}, edge});
    for (size_t k = 0; k < 2; ++k) {
      const int32_t child = cut(halves[k], sheet, depth + 1);
      mesh_.nodes[size_t(node)].child[k] = child;
    }
    return node;
  }

  int32_t leaf(const Corners& corners, uint32_t sheet) {
    uint32_t element = joined_element_;
    if (element == no_cluster) {
      element = uint32_t(element_sheet_.size());
      element_sheet_.push_back(sheet);
    }
    element_sheet_[element] = sheet;
    if (is_round_) sheet_pieces_[sheet].push_back(corners);
    mesh_.fragments.push_back({corners, element});
    return ~int32_t(mesh_.fragments.size() - 1);
  }

  const JoinPlan& plan_;
  RadiosityMesh& mesh_;
  Subdivider subdivider_;
  std::vector<uint32_t> element_sheet_, sheet_surface_;
  std::vector<std::vector<Corners>> sheet_pieces_;
  uint32_t surface_ = 0, joined_element_ = no_cluster;
  bool is_round_ = false;
};

// Returns the convex hull, counterclockwise, without collinear points (Andrew's monotone chain).
std::vector<Vec2d> convex_hull(std::vector<Vec2d> p) {
  std::sort(p.begin(), p.end(),
            [](const Vec2d& a, const Vec2d& b) { return a.x != b.x ? a.x < b.x : a.y < b.y; });
  p.erase(std::unique(p.begin(), p.end()), p.end());
  if (p.size() < 3) return {};
  const auto turn = [](const Vec2d& a, const Vec2d& b, const Vec2d& c) {
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
  };
  std::vector<Vec2d> hull;
  const auto add = [&](const Vec2d& q, size_t least) {
    while (hull.size() >= least && turn(hull[hull.size() - 2], hull.back(), q) <= 0)
      hull.pop_back();
    hull.push_back(q);
  };
  for (const Vec2d& q : p) add(q, 2);
  const size_t lower = hull.size() + 1;
  for (size_t i = p.size() - 1; i-- > 0;) add(p[i], lower);
  hull.pop_back();
  return hull;
}

Vec3d twice_area_vector(const std::vector<Vec3>& v, const Corners& c) {
  const Vec3d a(v[c[0]]);
  return cross(Vec3d(v[c[1]]) - a, Vec3d(v[c[2]]) - a);
}

// Returns the convex polygon that flat pieces form together; empty if they form none.
std::vector<Vec3> joined_polygon(const std::vector<Vec3>& v, const std::vector<Corners>& pieces) {
  constexpr size_t max_corners = 12;
  Vec3d sum;
  double area = 0;
  for (const Corners& c : pieces) {
    const Vec3d a = twice_area_vector(v, c);
    sum += a;
    area += length(a);
  }
  if (!(length(sum) > 0.99999 * area)) return {};
  const Framed frame(normalize(sum));
  const Vec3d origin(v[pieces[0][0]]);
  std::vector<Vec2d> points;
  for (const Corners& c : pieces) {
    for (const uint32_t i : c) {
      const Vec3d p = frame.to_local(Vec3d(v[i]) - origin);
      if (p.z * p.z > 1e-6 * area) return {};
      points.push_back({p.x, p.y});
    }
  }
  const std::vector<Vec2d> hull = convex_hull(std::move(points));
  if (hull.size() < 3 || hull.size() > max_corners) return {};
  double hull_area = 0;  // twice the area
  std::vector<Vec3> out;
  for (size_t i = 0; i < hull.size(); ++i) {
    const Vec2d a = hull[i], b = hull[(i + 1) % hull.size()];
    hull_area += a.x * b.y - a.y * b.x;
    out.push_back(Vec3(origin + frame.to_world({a.x, a.y, 0})));
  }
  if (std::abs(hull_area - area) > 1e-3 * area) return {};
  return out;
}

void add_piece(RadiosityMesh& mesh, const std::vector<Vec3>& corners) {
  mesh.pieces.push_back({uint32_t(mesh.piece_corners.size()), uint32_t(corners.size())});
  mesh.piece_corners.insert(mesh.piece_corners.end(), corners.begin(), corners.end());
}

Sheet make_sheet(const Scene& scene, const std::vector<Corners>& pieces, uint32_t surface,
                 RadiosityMesh& mesh) {
  const std::vector<Vec3>& v = mesh.geometry.positions;
  Sheet sheet;
  sheet.first_piece = uint32_t(mesh.pieces.size());
  float largest = 0;
  for (const Corners& c : pieces)
    for (const uint32_t i : c)
      largest = std::max({largest, std::abs(v[i].x), std::abs(v[i].y), std::abs(v[i].z)});
  sheet.offset = 4 * ray_offset(largest);
  const BaseSurface& s = mesh.geometry.surfaces[surface];
  if (s.bulge == Bulge::sphere) {
    sheet.round_centre = scene.spheres[s.index].centre;
    sheet.round_radius = scene.spheres[s.index].radius;
  }
  const std::vector<Vec3> polygon =
      pieces.size() > 1 ? joined_polygon(v, pieces) : std::vector<Vec3>{};
  if (!polygon.empty()) {
    add_piece(mesh, polygon);
  } else {
    for (const Corners& c : pieces) add_piece(mesh, {v[c[0]], v[c[1]], v[c[2]]});
  }
  sheet.last_piece = uint32_t(mesh.pieces.size());
  return sheet;
}

}  // namespace

Cut cut_surfaces(const Scene& scene, const JoinPlan& plan, RadiosityMesh& mesh) {
  const auto n = uint32_t(mesh.geometry.triangles.size());
  mesh.roots.assign(n, RadiosityMesh::no_root);
  Cutter cutter(scene, plan, mesh);
  for (uint32_t i = 0; i < n; ++i)
    if (!mesh.geometry.triangles[i].is_degenerate && mesh.same_as[i] == i) cutter.cut(i);
  for (size_t s = 0; s < cutter.sheet_pieces().size(); ++s)
    mesh.sheets.push_back(
        make_sheet(scene, cutter.sheet_pieces()[s], cutter.sheet_surface()[s], mesh));
  mesh.element_count = uint32_t(cutter.element_sheet().size());
  return {std::move(cutter.element_sheet())};
}

}  // namespace troffer
