// Where a scene's meshes cross a plane over a floor, seen on the floor.
#pragma once

#include <string>
#include <vector>

#include "report/plane_cells.h"
#include "scene/scene.h"

namespace troffer {

// A floor's plane and the vertical over it. Positions in the file's coordinates, m.
struct FloorPlane {
  Vec3d origin;
  Vec3d along, across, normal;  // unit, right-handed
  Vec3d up;                     // unit; need not be the normal

  // The foot on the plane of a vertical through p.
  Vec2d flat(const Vec3d& p) const {
    const Vec3d foot = p - up * (height_of(p)) - origin;
    return {dot(foot, along), dot(foot, across)};
  }
  double height_of(const Vec3d& p) const {  // along the vertical, m
    return dot(p - origin, normal) / dot(up, normal);
  }
  Vec3d place(const Vec2d& p) const { return origin + along * p.x + across * p.y; }
};

struct PlaneBounds {
  Vec2d lower, upper;
};

// Segments where meshes cross the parallel plane `height` metres higher, projected down along the
// vertical, of the kind that is named, with the mesh's back on their left. Solid are those of
// closed outlines of meshes that have a top. Those whose connected outline is shorter than `least`
// metres across, or which lie outside of the bounds, are left out.
std::vector<PlaneSegment> plane_cut(const Scene& scene, const FloorPlane& plane, double height,
                                    const PlaneBounds& bounds, double least, SegmentKind kind);

// Adds segments from loose ends to the nearest other segment, where that is at most `widest` metres
// away: walls that were meant to meet.
void close_gaps(std::vector<PlaneSegment>& walls, double widest);

}  // namespace troffer
