// Shortens a facet list of a source to the facets that matter for one of its cells. plan_cells.h
// uses it after it has split a cell. Lengths in metres.
#pragma once

#include <span>
#include <vector>

#include "shadow/cut_cells.h"

namespace troffer {

// Sets `out` to the facets that may meet a segment from the hull to the cell. A facet is left out
// if it lies beyond a plane that passes through an edge of the cell and has all of hull and cell on
// its other side.
void facets_before(const ReceiverHull& hull, const FlatCell& cell,
                   std::span<const FacetToAdd> facets, std::vector<FacetToAdd>& out);

}  // namespace troffer
