// Where light from lamps nearby differs so much over a cell that its mean says too little.
#pragma once

#include "cells/cell_map.h"
#include "transport/prepared_scene.h"

namespace troffer {

// By the irradiance, at nine places of the cell, from lights no farther away than a few times its
// width, but for broad ones, and at its middle from all others, as if nothing hid them: uneven
// where its standard deviation is more than half its mean. The strongest light of a place counts
// only where it is seen from there, for in a cove or behind a valance a cell has parts in light and
// parts in shadow that other surfaces see from different sides.
bool is_unevenly_lit(const PreparedScene& scene, const CellOutline& cell);

}  // namespace troffer
