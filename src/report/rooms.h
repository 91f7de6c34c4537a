// Finds the floors of rooms: the parts of a level slab between walls. find_floors() uses it.
//
// The outlines of the slab's faces, a cut through the walls above usual doors, and a cut through
// the objects on the floor divide the slab into cells (plane_cells.h). Cells that no wall separates
// form a room. Furniture counts as floor, as in EN 15193-1 and DIN 277 (net room area); walls,
// columns and parapets do not.
#pragma once

#include <string>
#include <vector>

#include "report/flat_faces.h"
#include "report/floor_outline.h"
#include "report/surface.h"
#include "transport/prepared_scene.h"

namespace troffer {

constexpr double least_floor = 1.5;  // m²; smaller regions are shafts, sills and steps

// A room's floor and surroundings.
struct Room {
  AssessedSurface floor;     // kind floor; profile and border are not set
  FloorSurroundings around;  // surroundings of its part without furniture
};

// Returns the rooms on faces in one plane with the unit normal n. The faces need not be connected.
// Rooms of less than 1.5 m² and regions thinner than .35 m are left out. up: unit length.
std::vector<Room> rooms_on(const PreparedScene& scene, const std::vector<const FlatFace*>& faces,
                           const Vec3d& n, const Vec3d& up);

// True if a level face at this height above a floor (m) is furniture (a bed, a table, a cabinet)
// and no podium or gallery. area: m².
bool is_furniture(double height, double area);

}  // namespace troffer
