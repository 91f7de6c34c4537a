// Answers a cluster for one part of a source and its facet list, and queues what needs rays. A flat
// source is divided into cells over which its light varies little. A spherical source becomes one
// disk per receiver. certified_light.cpp calls it.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "shadow/direct_rays.h"
#include "shadow/plan_cells.h"

namespace troffer {

// Working memory of the functions below.
struct PartMemory {
  std::vector<PlannedCell> cells;
  PilotMemory pilots;
  std::vector<float> unoccluded;  // unoccluded light of a cell, per receiver, sr
  std::vector<uint32_t> members;  // receivers that the cell reaches
  FacetList masked;
  ReceiverTree receivers, some_receivers;  // those of the part; those of a cell that reaches fewer
  SettleMemory settle;
  DirectRayMemory rays;
};

// Answers a flat part. stream: hash that is advanced for each cell of the source. If the part's
// list was too long, one facet may still prove it dark; otherwise rays are cast at once.
void settle_flat_part(const SourceTask& task, const SourcePart& part, uint64_t& stream,
                      ShadowScene& scene, PartMemory& memory, SourceResults& results);
// Answers a part of a sphere. Facets that may enter the sphere are removed from the part's list and
// handled by round_cover.h.
void settle_sphere_part(const SourceTask& task, SourcePart& part, PartMemory& memory,
                        SourceResults& results);

}  // namespace troffer
