// Tells over which cells light from nearby lamps differs so much that its mean says too little.
#pragma once

#include "cells/cell_map.h"
#include "transport/prepared_scene.h"

namespace troffer {

// True if the standard deviation of irradiance over nine places of the cell exceeds half its mean.
// Lights within a few widths of the cell count at each place, except broad ones; all others count
// at the middle, as if nothing hid them. The strongest light of a place counts only if it is
// visible. In a cove or behind a valance, a cell has lit and shaded parts, which other surfaces see
// from different sides.
bool is_unevenly_lit(const PreparedScene& scene, const CellOutline& cell);

}  // namespace troffer
