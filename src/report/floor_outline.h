// Computes the outline, sample places and surroundings of floors.
// The search for rooms (rooms.h) uses them. Coordinates are the file's, lengths in metres.
#pragma once

#include <vector>

#include "report/flat_faces.h"
#include "report/plane_cut.h"
#include "transport/prepared_scene.h"

namespace troffer {

constexpr double headroom = 1.9;  // m; free height that at least half of a floor needs
constexpr double rug = 0.05;      // m; flat objects up to that height belong to the floor

// Returns `count` places, spread over the faces by area. The same input yields the same places.
std::vector<Vec3d> places_on(const std::vector<const FlatFace*>& faces, size_t count);

// Returns the edges that belong to one triangle alone, with the face on their left. Coincident
// faces keep their own edges.
std::vector<PlaneSegment> outline_of(const std::vector<const FlatFace*>& faces,
                                     const FloorPlane& plane);

// True if p lies in the cell or on its border.
bool is_within(const PlaneCell& cell, const Vec2d& p);

// Surroundings of a part of a floor.
struct FloorSurroundings {
  double clear = 0;     // share of places with headroom
  double roofed = 0;    // share of places with headroom under a ceiling
  double enclosed = 0;  // share of level rays at eye height that hit something
};
// Casts rays from places on the cells to find their surroundings.
FloorSurroundings look_around(const PreparedScene& scene, const FloorPlane& plane,
                              const std::vector<const PlaneCell*>& cells);

}  // namespace troffer
