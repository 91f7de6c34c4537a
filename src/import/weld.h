// Welding of triangle soups: corners at equal positions become shared vertices. The importer of STL
// uses it. It runs in parallel, and its result does not depend on the number of threads.
#pragma once

#include <vector>

#include "import/read_progress.h"
#include "scene/scene.h"

namespace troffer {

// Returns a mesh from corners in groups of three. Corners at the same position become one vertex,
// in order of first occurrence. A corner that is not finite is a vertex of its own. Reports
// progress from `first` to 1.
Mesh weld(const std::vector<Vec3>& corners, const TellProgress& tell = {}, double first = 0);

}  // namespace troffer
