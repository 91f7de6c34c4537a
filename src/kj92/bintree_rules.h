// The rules of the 1992 bintree, each a function by itself on the nodes of a tree, with the row
// of the table in docs/bintree.md (in brackets) that states it. Bintree (bintree.h) runs them in
// turn. References: [1] Kok & Jansen, Eurographics '92, §3 and §4.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/random.h"
#include "kj92/bintree_nodes.h"

namespace troffer {

// Leaves whose rays are still to be cast, in the order in which they were made.
using BintreePending = std::vector<int32_t>;

// [rule 1] A tree of 2^level jittered rays, one to each cell of that level: spread evenly. All of
// them are pending.
void plant(BintreeNodes& nodes, int level, Random& jitter, BintreePending& pending);

// [rule 3] What a node with children a and b says about which to descend into.
// (a) exactly one is penumbra: that one. Returns -1 where the case does not apply.
int32_t choose_only_penumbra(const BintreeNodes& nodes, int32_t a, int32_t b);
// (b) the one with fewer samples; equal: the first.
int32_t choose_fewer_samples(const BintreeNodes& nodes, int32_t a, int32_t b);
// (c) neither is penumbra: the one whose flag differs from a neighbour's at the same level; both or
// neither: fewer samples.
int32_t choose_by_neighbours(const BintreeNodes& nodes, int32_t a, int32_t b);
// Whether a neighbour across one of the three sides that i does not share with its sibling has
// another flag. The sibling is left out because it cannot tell the two apart: it differs from i as
// i differs from it. Where the tree is coarser, the larger leaf is the neighbour.
bool differs_from_neighbours(const BintreeNodes& nodes, int32_t i);
// [rule 3] The leaf to split, by (a) to (c) from the root down.
int32_t choose_leaf(const BintreeNodes& nodes);
// The leaf to split where every cell is to be refined, whatever the flags: fewer samples all the
// way down. 2^k leaves are then always all of level k.
int32_t choose_leaf_evenly(const BintreeNodes& nodes);

// Splits a leaf and appends the empty child to `pending`; a leaf that is itself pending may be
// split, its entry then follows its ray. Returns the empty child.
int32_t split_pending(BintreeNodes& nodes, int32_t leaf, Random& jitter, BintreePending& pending);

// [rule 4] Splits larger leaves beside the leaves under `node`, and then beside those that come of
// it, until no leaf across a side is more than `difference` levels above; stops at
// `most_leaves` leaves (`leaves` counts on). Only sides count, not corners.
void enforce_level_difference(BintreeNodes& nodes, int32_t node, int difference, size_t most_leaves,
                              size_t& leaves, Random& jitter, BintreePending& pending,
                              std::vector<int32_t>& stack);
// The largest difference in level between leaves that share a side: for tests and statistics.
int largest_level_difference(const BintreeNodes& nodes);

// [reuse] Where a node and both its children are all light, or all shadow, the children become
// leaves: two rays stay where there were more, and say as much. No leaf comes above
// `initial_level`, and none comes to lie more than `difference` levels above a neighbour: rays that
// rule 4 demands would only be cast again. Deepest levels first. Nodes' values are up to date
// before and after.
void shrink(BintreeNodes& nodes, int initial_level, int difference, Random& coin,
            std::vector<int32_t>& order);

}  // namespace troffer
