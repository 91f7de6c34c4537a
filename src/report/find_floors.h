// The floors of a scene: one for each room.
#pragma once

#include <vector>

#include "report/rooms.h"
#include "transport/prepared_scene.h"

namespace troffer {

// Level faces at one height are one slab, whether they are joined or not; so are faces that slope
// by up to 20 degrees, each slope for itself, where there is a ceiling. A floor is what of a slab
// lies between a room's walls (rooms.h), with headroom over half of it or more; under a ceiling,
// where anything in the scene has one; and within walls, where anything is: what is open to half of
// its surroundings lies outside then. Tables, beds and rugs
// are no floors. By falling area; border: border_zone(); profile: "background". Names are those of
// nodes, with a number where several floors share one.
std::vector<AssessedSurface> find_floors(const PreparedScene& scene, const Vec3d& up);

// Which floors of those lie on faces of the node.
std::vector<AssessedSurface> floors_of_node(const std::vector<AssessedSurface>& floors,
                                            const std::vector<FlatFace>& faces);

// Height of the surface over the highest of the floors under its middle that is at most so far
// below; 0 where there is none.
double height_over(const std::vector<AssessedSurface>& floors, const AssessedSurface& surface,
                   const Vec3d& up, double most);

// Names that repeat, or are missing, get numbers: from the far left corner to the near right one,
// row by row, as the plan shows them.
void number_names(std::vector<AssessedSurface>& surfaces, const Vec3d& up);

}  // namespace troffer
