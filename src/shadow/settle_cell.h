// A cell's list of facets -> answers: by certificates for the receivers together, the cluster
// halved while that shortens lists, and masks for what is left.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "shadow/mask_cell.h"
#include "shadow/receiver_tree.h"

namespace troffer {

struct SettleMemory {
  static constexpr size_t most_depth = 8;       // of halvings of the cluster
  std::array<FacetList, most_depth + 2> lists;  // by depth; the first is the cell's
  FacetFlags flags;
  MaskMemory masks;
};

// What the facets prove for all receivers in the hull; where it is neither, `left` are the facets
// that may hide some of the cell from some receiver.
enum class Certificate : uint8_t { none, lit, dark };
Certificate certify(const SourceCellTask& cell, const ReceiverHull& hull, const FacetList& facets,
                    FacetFlags& flags, FacetList& left);

// Answers the receivers by memory.lists[0].
void settle_cell(const SourceCellTask& cell, ReceiverTree& receivers, SettleMemory& memory,
                 SourceResults& results);

}  // namespace troffer
