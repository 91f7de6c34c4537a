// Rules of the 1992 bintree, one function each, on the nodes of a tree. Tags in brackets name the
// rows of the table in docs/method/bintree.md. Bintree (bintree.h) applies them in turn.
// References: [1] Kok & Jansen, Eurographics '92, §3 and §4.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/random.h"
#include "kj92/bintree_nodes.h"

namespace troffer {

// Leaves whose rays have yet to be cast, in order of creation.
using BintreePending = std::vector<int32_t>;

// [rule 1] Resets to a tree of 2^level jittered rays, one per cell of that level. All of them are
// pending.
void plant(BintreeNodes& nodes, int level, Random& jitter, BintreePending& pending);

// [rule 3] The next functions choose between the children a and b of a node.
// (a) Returns the only penumbra child, or -1 if there is not exactly one.
int32_t choose_only_penumbra(const BintreeNodes& nodes, int32_t a, int32_t b);
// (b) Returns the child with fewer samples; a if equal.
int32_t choose_fewer_samples(const BintreeNodes& nodes, int32_t a, int32_t b);
// (c) For two children that are not penumbra: returns the one whose flag differs from a neighbour's
// at the same level. If both or neither do, returns the one with fewer samples.
int32_t choose_by_neighbours(const BintreeNodes& nodes, int32_t a, int32_t b);
// True if a neighbour across one of the three outer sides of i has another flag. The sibling does
// not count, because it differs from i exactly if i differs from it. Where the tree is coarser, the
// larger leaf is the neighbour.
bool differs_from_neighbours(const BintreeNodes& nodes, int32_t i);
// [rule 3] Returns the leaf to split, by (a) to (c) from the root down.
int32_t choose_leaf(const BintreeNodes& nodes);
// Returns the leaf to split for even refinement: the child with fewer samples at each step. All 2^k
// leaves are then of level k.
int32_t choose_leaf_evenly(const BintreeNodes& nodes);

// Splits a leaf, appends the empty child to `pending` and returns it. If the leaf itself is
// pending, its entry moves to the child with its ray.
int32_t split_pending(BintreeNodes& nodes, int32_t leaf, Random& jitter, BintreePending& pending);

// [rule 4] Splits larger neighbours of the leaves under `node`, and then neighbours of those.
// Afterwards no leaf is more than `difference` levels above a leaf across a side. Corners do not
// count. Stops at `most_leaves` leaves; `leaves` is the running count.
void enforce_level_difference(BintreeNodes& nodes, int32_t node, int difference, size_t most_leaves,
                              size_t& leaves, Random& jitter, BintreePending& pending,
                              std::vector<int32_t>& stack);
// Returns the largest level difference between leaves that share a side, for tests and statistics.
int largest_level_difference(const BintreeNodes& nodes);

// [reuse] Where a node and both children are all light, or all shadow, turns the children into
// leaves, deepest levels first. Two rays then carry the same information as more did. No leaf rises
// above `initial_level`, or more than `difference` levels above a neighbour, since rule 4 would
// split it again. Node values must be up to date, and are so afterwards.
void shrink(BintreeNodes& nodes, int initial_level, int difference, Random& coin,
            std::vector<int32_t>& order);

}  // namespace troffer
