// Finds the floors of a scene: one for each room.
// The search for surfaces, for eyes and for floor area uses them. Coordinates are the file's,
// lengths in metres.
#pragma once

#include <vector>

#include "report/rooms.h"
#include "transport/prepared_scene.h"

namespace troffer {

// Returns the floors, by falling area.
// Level faces at one height form one slab, joined or not. Faces that slope by up to 20 degrees form
// slabs, too, one per slope, if they have a ceiling. A floor is a part of a slab between a room's
// walls (rooms.h) with headroom over at least half of it.
// If any part of the scene has a ceiling, floors need one. If any part lies within walls, parts
// that are open to half of their surroundings lie outside and are no floors. Tables, beds and rugs
// are no floors.
// border: border_zone(); profile: "background"; name: the node's, with a number if several share
// it.
std::vector<AssessedSurface> find_floors(const PreparedScene& scene, const Vec3d& up);

// Returns those of the floors that lie on faces of a node.
std::vector<AssessedSurface> floors_of_node(const std::vector<AssessedSurface>& floors,
                                            const std::vector<FlatFace>& faces);

// Returns the height of a surface above the highest floor under its middle that is at most `most`
// metres below it; 0 if there is none.
double height_over(const std::vector<AssessedSurface>& floors, const AssessedSurface& surface,
                   const Vec3d& up, double most);

// Appends numbers to names that repeat, and names surfaces without a name after their kind. Numbers
// run row by row from the far left to the near right corner, as the plan shows them.
void number_names(std::vector<AssessedSurface>& surfaces, const Vec3d& up);

}  // namespace troffer
