// Corners of triangles -> vertices that triangles share.
#pragma once

#include <vector>

#include "import/read_progress.h"
#include "scene/scene.h"

namespace troffer {

// A mesh of triangles whose corners come one after the other, three by three: those in one place
// are one vertex, numbered as they first come; one that is not finite is a vertex of its own. Tells
// the part of the whole from `first` on.
Mesh weld(const std::vector<Vec3>& corners, const TellProgress& tell = {}, double first = 0);

}  // namespace troffer
