// Shortens a facet list of a source to the facets that matter for one of its cells. plan_cells.h
// uses it after it has split a cell. Lengths in metres.
#pragma once

#include <span>
#include <vector>

#include "shadow/cut_cells.h"

namespace troffer {

// Sets `out` to the facets that may meet a segment from the hull to the cell. Planes through an
// edge of the cell that have hull and cell on one side decide. A facet beyond one of them is left
// out.
void facets_for_cell(const ReceiverHull& hull, const FlatCell& cell,
                     std::span<const FacetToAdd> facets, std::vector<FacetToAdd>& out);

}  // namespace troffer
