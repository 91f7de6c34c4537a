// Outline, sample places and surroundings of floors.
#pragma once

#include <vector>

#include "report/flat_faces.h"
#include "report/plane_cut.h"
#include "transport/prepared_scene.h"

namespace troffer {

constexpr double headroom = 1.9;  // m over at least half of a floor's open part
constexpr double rug = 0.05;      // m: what lies flat on a floor belongs to it

// Places spread over faces by area, the same each time.
std::vector<Vec3d> places_on(const std::vector<const FlatFace*>& faces, size_t count);

// Edges of one triangle alone, with the face on their left; faces that lie on each other keep
// theirs.
std::vector<PlaneSegment> outline_of(const std::vector<const FlatFace*>& faces,
                                     const FloorPlane& plane);

bool is_within(const PlaneCell& cell, const Vec2d& p);

// Objects around and above a part of a floor.
struct FloorSurroundings {
  double clear = 0;     // share of its places that have headroom
  double roofed = 0;    // … that have it under a ceiling
  double enclosed = 0;  // share of level rays at eye height that meet something
};
FloorSurroundings look_around(const PreparedScene& scene, const FloorPlane& plane,
                              const std::vector<const PlaneCell*>& cells);

}  // namespace troffer
