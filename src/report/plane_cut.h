// Cuts a scene's meshes with a plane above a floor, and projects the cut onto the floor.
// The search for rooms uses it. Positions are in the file's coordinates, lengths in metres.
#pragma once

#include <string>
#include <vector>

#include "report/plane_cells.h"
#include "scene/scene.h"

namespace troffer {

// A floor's plane and the vertical above it.
struct FloorPlane {
  Vec3d origin;
  Vec3d along, across, normal;  // unit, right-handed
  Vec3d up;                     // unit; need not be the normal

  // Projects p onto the plane along the vertical.
  Vec2d flat(const Vec3d& p) const {
    const Vec3d foot = p - up * (height_of(p)) - origin;
    return {dot(foot, along), dot(foot, across)};
  }
  double height_of(const Vec3d& p) const {  // along the vertical, m
    return dot(p - origin, normal) / dot(up, normal);
  }
  Vec3d place(const Vec2d& p) const { return origin + along * p.x + across * p.y; }
};

// A bounding rectangle in the plane.
struct PlaneBounds {
  Vec2d lower, upper;
};

// Returns the segments in which meshes cross the parallel plane `height` metres above the floor,
// projected down along the vertical. They have the given kind and the mesh's back on their left.
// Segments of closed outlines of meshes with a top are solid. Connected outlines narrower than
// `least` metres are left out, as are segments outside of the bounds.
std::vector<PlaneSegment> plane_cut(const Scene& scene, const FloorPlane& plane, double height,
                                    const PlaneBounds& bounds, double least, SegmentKind kind);

// Adds a segment from each loose end to the nearest other segment if it is at most `widest` metres
// away: walls that were meant to meet.
void close_gaps(std::vector<PlaneSegment>& walls, double widest);

}  // namespace troffer
