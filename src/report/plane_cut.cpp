#include "report/plane_cut.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <unordered_map>
#include <utility>

#include "base/disjoint_sets.h"
#include "base/random.h"
#include "scene/mesh_in_world.h"

namespace troffer {

namespace {

// Computes the segment in which a triangle crosses the plane. Returns false if it does not. d:
// signed distances of the corners.
bool cross(const std::array<Vec3d, 3>& p, const std::array<double, 3>& d,
           std::array<Vec3d, 2>& end) {
  size_t n = 0;
  for (size_t k = 0; k < 3; ++k) {
    const size_t m = (k + 1) % 3;
    if ((d[k] < 0) == (d[m] < 0)) continue;
    const double t = d[k] / (d[k] - d[m]);
    if (n < 2) end[n++] = p[k] + (p[m] - p[k]) * t;
  }
  return n == 2;
}

uint64_t key_of(const Vec2d& p) {
  return hash_of(uint64_t(std::llround(p.x * 1e4)), uint64_t(std::llround(p.y * 1e4)));
}

// A segment of a mesh's cross-section, with the mesh's back on its left.
struct Cut {
  PlaneSegment segment;
  uint32_t mesh = 0;
};

struct Outline {
  PlaneBounds bounds;
  double area = 0;  // area of a closed outline, m²; > 0 if the inside is on its left
  bool is_closed = true, is_capped = true;
  double width() const {
    return std::hypot(bounds.upper.x - bounds.lower.x, bounds.upper.y - bounds.lower.y);
  }
};

class Outlines {
 public:
  // is_capped: per mesh, true if it has upward faces above the plane.
  Outlines(std::vector<Cut> cuts, const std::vector<uint8_t>& is_capped)
      : cuts_(std::move(cuts)), sets_(cuts_.size()) {
    std::unordered_map<uint64_t, uint32_t> first;
    std::unordered_map<uint64_t, int> ends;
    for (uint32_t i = 0; i < cuts_.size(); ++i)
      for (const Vec2d& p : {cuts_[i].segment.a, cuts_[i].segment.b}) {
        // Meshes that touch keep separate outlines.
        const uint64_t key = hash_of(key_of(p), cuts_[i].mesh);
        ends[key] += p == cuts_[i].segment.a ? 1 : -1;
        const auto [at, is_new] = first.emplace(key, i);
        if (!is_new) sets_.join(at->second, i);
      }
    for (uint32_t i = 0; i < cuts_.size(); ++i) {
      const PlaneSegment& s = cuts_[i].segment;
      Outline& o = outlines_.emplace(sets_.find(i), Outline{{s.a, s.a}}).first->second;
      o.area += 0.5 * (s.a.x * s.b.y - s.a.y * s.b.x);
      o.is_capped = o.is_capped && is_capped[cuts_[i].mesh] != 0;
      for (const Vec2d& p : {s.a, s.b}) {
        o.is_closed = o.is_closed && ends[hash_of(key_of(p), cuts_[i].mesh)] == 0;
        o.bounds.lower = {std::min(o.bounds.lower.x, p.x), std::min(o.bounds.lower.y, p.y)};
        o.bounds.upper = {std::max(o.bounds.upper.x, p.x), std::max(o.bounds.upper.y, p.y)};
      }
    }
  }

  // Returns the segments of outlines that are at least `least` wide. Outlines of bodies, holes
  // included, are marked as solid.
  std::vector<PlaneSegment> segments(double least) {
    std::vector<PlaneSegment> kept;
    for (uint32_t i = 0; i < cuts_.size(); ++i) {
      const Outline& o = outlines_.at(sets_.find(i));
      if (o.width() < least) continue;
      kept.push_back(cuts_[i].segment);
      kept.back().is_solid = o.is_closed && o.is_capped && (o.area > 0 || is_hole(i));
    }
    return kept;
  }

 private:
  // True if an outline lies within the outline of a body of the same mesh.
  bool is_hole(uint32_t i) {
    const uint32_t set = sets_.find(i);
    const auto known = holes_.find(set);
    if (known != holes_.end()) return known->second;
    const Vec2d p = cuts_[set].segment.a;
    int turns = 0;
    for (uint32_t k = 0; k < cuts_.size(); ++k) {
      const uint32_t other = sets_.find(k);
      if (cuts_[k].mesh != cuts_[i].mesh || other == set || !(outlines_.at(other).area > 0))
        continue;
      const Vec2d &a = cuts_[k].segment.a, &b = cuts_[k].segment.b;
      if ((a.y <= p.y) == (b.y <= p.y)) continue;
      const double x = a.x + (b.x - a.x) * (p.y - a.y) / (b.y - a.y);
      if (x > p.x) turns += a.y < b.y ? 1 : -1;
    }
    return holes_.emplace(set, turns > 0).first->second;
  }

  std::vector<Cut> cuts_;
  DisjointSets sets_;
  std::unordered_map<uint32_t, Outline> outlines_;
  std::unordered_map<uint32_t, bool> holes_;
};

}  // namespace

std::vector<PlaneSegment> plane_cut(const Scene& scene, const FloorPlane& plane, double height,
                                    const PlaneBounds& bounds, double least, SegmentKind kind) {
  std::vector<Cut> cuts;
  std::vector<uint8_t> is_capped;
  for_each_mesh(scene, [&](uint32_t, const MeshInWorld& mesh) {
    const auto number = uint32_t(is_capped.size());
    is_capped.push_back(0);
    for (size_t i = 0; i < mesh.size(); ++i) {
      const auto c = mesh.corners(i);
      std::array<Vec3d, 3> p;
      std::array<double, 3> d;
      for (size_t k = 0; k < 3; ++k) {
        p[k] = Vec3d(c[k]) + scene.origin;
        d[k] = plane.height_of(p[k]) - height;
      }
      const Vec3d n = troffer::cross(p[1] - p[0], p[2] - p[0]);
      if (std::min({d[0], d[1], d[2]}) > 0 && dot(n, plane.up) > 0.5 * length(n))
        is_capped[number] = 1;
      std::array<Vec3d, 2> end;
      if (!cross(p, d, end)) continue;
      Vec2d a = plane.flat(end[0]), b = plane.flat(end[1]);
      if (std::max(a.x, b.x) < bounds.lower.x || std::min(a.x, b.x) > bounds.upper.x ||
          std::max(a.y, b.y) < bounds.lower.y || std::min(a.y, b.y) > bounds.upper.y)
        continue;
      // The triangle's front must face the right of the segment.
      if (dot(n, plane.along) * (b.y - a.y) - dot(n, plane.across) * (b.x - a.x) < 0)
        std::swap(a, b);
      cuts.push_back({{a, b, kind}, number});
    }
  });
  return Outlines(std::move(cuts), is_capped).segments(least);
}

void close_gaps(std::vector<PlaneSegment>& walls, double widest) {
  std::unordered_map<uint64_t, int> ends;
  for (const PlaneSegment& s : walls)
    for (const Vec2d& p : {s.a, s.b}) ++ends[key_of(p)];
  const size_t count = walls.size();
  for (size_t i = 0; i < count; ++i)
    for (const Vec2d& p : {walls[i].a, walls[i].b}) {
      if (ends[key_of(p)] > 1) continue;
      double nearest = widest * widest;
      Vec2d foot = p;
      for (size_t k = 0; k < count; ++k) {
        if (k == i) continue;
        const Vec2d way = walls[k].b - walls[k].a, to = p - walls[k].a;
        const double l = dot(way, way);
        const Vec2d at = walls[k].a + way * (l > 0 ? std::clamp(dot(to, way) / l, 0.0, 1.0) : 0.0);
        const double distance = dot(at - p, at - p);
        if (distance >= nearest) continue;
        nearest = distance;
        foot = at;
      }
      if (!(foot == p)) walls.push_back({p, foot, walls[i].kind});
    }
}

}  // namespace troffer
