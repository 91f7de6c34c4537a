// Rasterization of a straight segment in space: visits its points pixel by pixel. Used to follow
// light outlines and to search for sub-pixel features.
#pragma once

#include <algorithm>
#include <cmath>

#include "render/camera.h"
#include "render/tile.h"

namespace troffer {

// Visits points of a segment within the region, at most half a pixel apart and at least one in
// every pixel that it crosses. Bisection skips what lies beside the region, so long segments that
// mostly miss it are cheap. Points behind the camera are left out, as is everything longer than
// 2^15 pixels.
class SegmentWalk {
 public:
  // The camera must outlive this object.
  SegmentWalk(const ViewingCamera& camera, const PixelRect& region)
      : camera_(camera), region_(region) {}

  // Calls visit(position, raster) for both ends of every part, so most points come twice.
  template <class Visit>
  void walk(const Vec3& a, const Vec3& b, const Visit& visit) const {
    halve(at(a), at(b), 0, visit);
  }

 private:
  struct Point {
    Vec3 position;
    Vec2 raster;
    bool is_before = false;  // in front of the camera
  };

  Point at(const Vec3& p) const {
    Point q{p, {}, false};
    q.is_before = camera_.raster_of(p, q.raster);
    return q;
  }
  bool is_beside(const Point& a, const Point& b) const {
    const auto x0 = float(region_.x0), x1 = float(region_.x1), y0 = float(region_.y0),
               y1 = float(region_.y1);
    return (a.raster.x < x0 && b.raster.x < x0) || (a.raster.x >= x1 && b.raster.x >= x1) ||
           (a.raster.y < y0 && b.raster.y < y0) || (a.raster.y >= y1 && b.raster.y >= y1);
  }
  template <class Visit>
  void halve(const Point& a, const Point& b, int depth, const Visit& visit) const {
    constexpr int deepest = 16;
    if (!a.is_before && !b.is_before) return;
    if (a.is_before && b.is_before) {
      if (is_beside(a, b)) return;
      const Vec2 d = a.raster - b.raster;
      if (std::abs(d.x) <= 0.5f && std::abs(d.y) <= 0.5f) {
        for (const Point* p : {&a, &b})
          if (is_inside(p->raster)) visit(p->position, p->raster);
        visit_between(a, b, visit);
        return;
      }
    }
    if (depth == deepest) return;
    const Point middle = at((a.position + b.position) * 0.5f);
    halve(a, middle, depth + 1, visit);
    halve(middle, b, depth + 1, visit);
  }
  // If the pixels of two points meet only at a corner, visits a point in the third pixel, whose
  // corner the line cuts.
  template <class Visit>
  void visit_between(const Point& a, const Point& b, const Visit& visit) const {
    const auto border = [](float p, float q) { return std::floor(std::max(p, q)); };
    const auto is_crossed = [&](float p, float q) { return std::floor(p) != std::floor(q); };
    const Vec2 &p = a.raster, &q = b.raster;
    if (!is_crossed(p.x, q.x) || !is_crossed(p.y, q.y)) return;
    const float tx = (border(p.x, q.x) - p.x) / (q.x - p.x),
                ty = (border(p.y, q.y) - p.y) / (q.y - p.y), t = 0.5f * (tx + ty);
    const Vec2 between = p + (q - p) * t;
    if (is_inside(between)) visit(a.position + (b.position - a.position) * t, between);
  }
  bool is_inside(const Vec2& r) const {
    return r.x >= float(region_.x0) && r.x < float(region_.x1) && r.y >= float(region_.y0) &&
           r.y < float(region_.y1);
  }

  const ViewingCamera& camera_;
  PixelRect region_;
};

}  // namespace troffer
