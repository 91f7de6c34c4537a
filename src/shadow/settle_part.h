// A part of a source and its list of facets -> answers and what waits for rays. A flat source is
// cut into cells over which its light does not vary much; of a sphere each receiver has its own
// disk.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "shadow/direct_rays.h"
#include "shadow/plan_cells.h"

namespace troffer {

struct PartMemory {
  std::vector<PlannedCell> cells;
  PilotMemory pilots;
  std::vector<float> unoccluded;  // per receiver, of a cell
  std::vector<uint32_t> members;  // whom the cell lights
  FacetList masked;
  ReceiverTree receivers, some_receivers;  // of the part, and of the cell where these are fewer
  SettleMemory settle;
  DirectRayMemory rays;
};

// stream: hash that each cell of the source takes on. Of parts whose lists were too long, one facet
// may prove that all is dark; else rays are cast now.
void settle_flat_part(const SourceTask& task, const SourcePart& part, uint64_t& stream,
                      ShadowScene& scene, PartMemory& memory, SourceResults& results);
// Facets that may enter the sphere leave the part's list: what of them lies outside is covered.
void settle_sphere_part(const SourceTask& task, SourcePart& part, PartMemory& memory,
                        SourceResults& results);

}  // namespace troffer
