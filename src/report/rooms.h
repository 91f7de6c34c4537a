// The floor of rooms: what of a level slab lies between walls.
//
// The slab's faces, the walls' cross-section above usual doors and the cross-section of what stands
// on the floor are cut into cells (plane_cells.h). Cells that no wall parts are a room. Furniture
// counts as floor, as in EN 15193-1 and DIN 277 (net room area); walls, columns and parapets do
// not.
#pragma once

#include <string>
#include <vector>

#include "report/flat_faces.h"
#include "report/floor_outline.h"
#include "report/surface.h"
#include "transport/prepared_scene.h"

namespace troffer {

constexpr double least_floor = 1.5;  // m²; smaller regions are shafts, sills and steps

struct Room {
  AssessedSurface floor;     // kind floor; profile and border are not set
  FloorSurroundings around;  // of its part without furniture
};

// Rooms on faces in one plane with the unit normal n, which need not be joined. Rooms of less than
// 1.5 m² and regions thinner than .35 m are left out. up: unit.
std::vector<Room> rooms_on(const PreparedScene& scene, const std::vector<const FlatFace*>& faces,
                           const Vec3d& n, const Vec3d& up);

// Whether a level face so high over a floor is furniture (a bed, a table, a cabinet) and not a
// podium or a gallery.
bool is_furniture(double height, double area);

}  // namespace troffer
