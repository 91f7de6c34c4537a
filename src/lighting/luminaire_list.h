// --luminaires: many measured luminaires from a CSV list. add_daylight() uses it, and the report
// command for their power. Positions are in metres, angles in degrees, powers in W.
#pragma once

#include <string>
#include <vector>

#include "scene/scene.h"

namespace troffer {

// Adds the luminaires of a CSV file with the header
//   file,x,y,z,dx,dy,dz,rotation,dimming,lumens,kelvin
// to the scene; columns after z are optional. `file` is a photometric file, relative to the list.
// x,y,z is its position in the coordinates of the scene file, dx,dy,dz the direction of its nadir
// (default: `down`). `rotation` turns the plane C0 about the nadir, from the scene's x, in degrees
// (clockwise seen from above if it points down). `dimming` is a factor (default 1). `lumens` and
// `kelvin` are as in --luminaire. Lights are named luminaire0, luminaire1 and so on. Warns of
// unused columns. Throws InputError with line and column.
void add_luminaire_list(Scene& scene, const std::string& path, const Vec3& down);

// Returns the dimmed power of each luminaire of the list in W, in order; 0 if its file states none.
std::vector<double> watts_of_luminaire_list(const std::string& path, const Vec3& down);

}  // namespace troffer
