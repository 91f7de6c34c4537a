// Which surfaces of a scene are to be assessed: those that are named, or desks and floors by
// themselves.
#pragma once

#include <string>
#include <vector>

#include "report/surface.h"
#include "transport/prepared_scene.h"

namespace troffer {

// A part of the scene by its node, or a rectangle.
struct SurfaceRequest {
  std::string node;     // empty: the rectangle
  std::string profile;  // id; empty: the usual one
  std::string name;     // for the report; empty: the node's
  double lift = 0;      // m along the normal, at which it is measured
  double border = -1;   // m; < 0: none
  // Of a rectangle, in the file's coordinates, m: a corner and two sides at right angles, such that
  // side_a × side_b looks to where the light comes from.
  Vec3d corner, side_a, side_b;
};

struct FoundSurfaces {
  std::vector<AssessedSurface> surfaces;  // desks and what was named first, then floors
  std::vector<AssessedSurface> floors;    // all floors, assessed or not, for areas and eyes
  std::vector<std::string> notes;         // what was left out, for people
};

// By themselves:
// - floors: find_floors.h;
// - desks: upward faces of .25 m² and more whose shorter side is .35 m or more, .6 to .95 m above a
//   floor, with .5 m to what is above at half of their points or more; in natural order of names.
// Floors are assessed by the profile "background" where there are desks; where there are none, a
// plane `work_plane` metres above each floor is, by `profile`. `profile`: of desks and named
// surfaces. up: unit. At most 64 surfaces, of which floors are kept first; notes tell of more.
FoundSurfaces find_surfaces(const PreparedScene& scene, const Vec3d& up, const std::string& profile,
                            double work_plane);

// What is asked for. UsageError for nodes that do not exist or are neither flat nor have faces that
// look upward (of these, the floors within their rooms are taken; where none is a floor, faces at
// least a tenth as large as the largest, each for itself), and for rectangles without area.
FoundSurfaces asked_surfaces(const PreparedScene& scene, const Vec3d& up,
                             const std::vector<SurfaceRequest>& requests,
                             const std::string& profile);

// Which of the points (in the file's coordinates) stand within a body (above.h), or less than 3 cm
// under something. One per point, 1 where so.
std::vector<uint8_t> covered_points(const PreparedScene& scene, const std::vector<Vec3d>& points,
                                    const Vec3d& up);

// Moves points that lie less than 5 cm under the top of something flat (a rug) onto it. up: unit.
void lift_onto_rugs(const PreparedScene& scene, const Vec3d& up, std::vector<GridPoint>& points);

// Whether light from beyond the scene reaches any of the points: some of 256 rays from each (from
// 64 of them, where there are more) towards the side of `up` leaves the scene.
bool sees_beyond(const PreparedScene& scene, const std::vector<Vec3d>& points, const Vec3d& up);

}  // namespace troffer
