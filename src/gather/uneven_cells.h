// Where light differs so much over a cell that its mean says too little.
#pragma once

#include "cells/cell_map.h"
#include "transport/prepared_scene.h"

namespace troffer {

// By lamps nearby (is_unevenly_lit), or, of what the picture looks at, where something stands close
// above a part of it and nothing above another: a lamp or a shelf before a wall, and the wall
// beside it. Light falls off towards the dark over about as much as what stands there is high, and
// some see the one part, others the other. The scene must outlive what is returned; any number of
// threads may call it.
CellMap::IsUneven uneven_cells(const PreparedScene& scene);

}  // namespace troffer
