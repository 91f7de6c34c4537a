// Answers a cluster for one source cell and its facet list. Certificates come first. The cluster is
// halved while that shortens lists, and masks answer the rest. settle_part.cpp calls it.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "shadow/mask_cell.h"
#include "shadow/receiver_tree.h"

namespace troffer {

// Working memory of settle_cell.
struct SettleMemory {
  static constexpr size_t most_depth = 8;       // halvings of the cluster
  std::array<FacetList, most_depth + 2> lists;  // by depth; the first holds the cell's facets
  FacetFlags flags;
  MaskMemory masks;
};

// Proof about all receivers of a hull: all of the cell is visible (lit), nothing is (dark), or
// neither.
enum class Certificate : uint8_t { none, lit, dark };
// Tries to prove the cell lit or dark for all receivers in the hull. Without a proof, sets `left`
// to the facets that may hide some of the cell from some receiver.
Certificate certify(const SourceCellTask& cell, const ReceiverHull& hull, const FacetList& facets,
                    FacetFlags& flags, FacetList& left);

// Answers all receivers of the tree for the cell; memory.lists[0] holds its facets.
void settle_cell(const SourceCellTask& cell, ReceiverTree& receivers, SettleMemory& memory,
                 SourceResults& results);

}  // namespace troffer
