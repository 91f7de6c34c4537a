// --luminaires: many measured luminaires, by a list.
#pragma once

#include <string>
#include <vector>

#include "scene/scene.h"

namespace troffer {

// Adds the luminaires of a CSV file to the scene, by the header
//   file,x,y,z,dx,dy,dz,rotation,dimming
// of which columns from dx on may be missing: a photometric file, beside the list; where it hangs,
// in the file's coordinates; where its nadir lies (`down`), degrees by which its plane C0 is turned
// about that from the scene's x (clockwise seen from above where it looks down), and a factor (1).
// They are called luminaire0, luminaire1 … A warning names columns that are not used. InputError
// with line and column.
void add_luminaire_list(Scene& scene, const std::string& path, const Vec3& down);

// Power of each of the list's luminaires by its file, dimmed, W, in order: 0 where the file
// states nothing.
std::vector<double> watts_of_luminaire_list(const std::string& path, const Vec3& down);

}  // namespace troffer
