// Finds cells over which light varies so much that their mean does not describe it.
#pragma once

#include "cells/cell_map.h"
#include "transport/prepared_scene.h"

namespace troffer {

// Returns the test for CellMap::halve_where(). A cell is uneven if nearby lamps light it unevenly
// (is_unevenly_lit()). A cell that the picture looks at is also uneven if something stands close
// above a part of it, such as a shelf before a wall. Light falls off there over about the height of
// that thing, and some rays see the bright part, others the dark one. The scene must outlive the
// test. Any number of threads may call it.
CellMap::IsUneven uneven_cells(const PreparedScene& scene);

}  // namespace troffer
