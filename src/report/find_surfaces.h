// Finds the surfaces of a scene to assess: the requested ones, or desks and floors.
// assess() uses this module. Coordinates are the file's, lengths in metres.
#pragma once

#include <string>
#include <vector>

#include "report/surface.h"
#include "transport/prepared_scene.h"

namespace troffer {

// A request for a surface: a node of the scene, or a rectangle.
struct SurfaceRequest {
  std::string node;     // node's name; empty: the rectangle
  std::string profile;  // profile id; empty: the default profile
  std::string name;     // name in the report; empty: the node's name
  double lift = 0;      // offset of the measuring points along the normal, m
  double border = -1;   // border zone without points, m; < 0: none
  // Rectangle: a corner and two sides at right angles, in the file's coordinates, m. side_a ×
  // side_b points to where the light comes from.
  Vec3d corner, side_a, side_b;
};

// Result of the search.
struct FoundSurfaces {
  std::vector<AssessedSurface> surfaces;  // desks and named surfaces first, then floors
  std::vector<AssessedSurface> floors;    // all floors, assessed or not, for areas and eyes
  std::vector<std::string> notes;         // sentences about omitted surfaces
};

// Finds floors (find_floors.h) and desks. Desks are upward faces of at least .25 m² whose shorter
// side is at least .35 m. They lie .6 to .95 m above a floor, with .5 m of free space above at
// least half of their points.
// Desks come in natural order of names and get `profile`; floors then get the profile "background".
// Without desks, a plane `work_plane` metres above each floor is assessed by `profile` instead. At
// most 64 surfaces are returned; desks are dropped before floors, and a note says so. up: unit
// length.
FoundSurfaces find_surfaces(const PreparedScene& scene, const Vec3d& up, const std::string& profile,
                            double work_plane);

// Returns the requested surfaces. A node that is a slab yields its floors, bounded by the walls on
// it. A flat node yields its faces, whatever their direction. Any other node yields its upward
// faces of at least a tenth of the largest one's area. `profile`: default for requests without one.
// Throws UsageError for unknown nodes, for nodes that are neither flat nor have upward faces, and
// for rectangles without area.
FoundSurfaces asked_surfaces(const PreparedScene& scene, const Vec3d& up,
                             const std::vector<SurfaceRequest>& requests,
                             const std::string& profile);

// Returns one flag per point (in the file's coordinates): 1 if it lies inside a body (above.h), or
// less than 3 cm below an object.
std::vector<uint8_t> covered_points(const PreparedScene& scene, const std::vector<Vec3d>& points,
                                    const Vec3d& up);

// Moves points that lie less than 5 cm under the top of something flat (a rug) onto it. up: unit
// length.
void lift_onto_rugs(const PreparedScene& scene, const Vec3d& up, std::vector<GridPoint>& points);

// True if light from outside the scene reaches any of the points: if one of 256 rays per point,
// toward the side of `up`, leaves the scene. Tests at most 64 of the points, evenly chosen.
bool sees_beyond(const PreparedScene& scene, const std::vector<Vec3d>& points, const Vec3d& up);

}  // namespace troffer
