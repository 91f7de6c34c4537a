// The facets that matter for one cell of a source, of those before a larger part of it.
#pragma once

#include <span>
#include <vector>

#include "shadow/cut_cells.h"

namespace troffer {

// Sets `out` to the facets that may meet a segment from the hull's receivers to the cell: leaves
// out what lies beyond a plane through one of the cell's edges that has all of cell and hull before
// it.
void facets_before(const ReceiverHull& hull, const FlatCell& cell,
                   std::span<const FacetToAdd> facets, std::vector<FacetToAdd>& out);

}  // namespace troffer
