#include "kj92/bintree_rules.h"

#include <algorithm>
#include <array>

#include "base/error.h"

namespace troffer {

namespace {

constexpr BintreeSide opposite(BintreeSide side) {
  return BintreeSide(uint8_t(side) ^ 1);
}

void plant_under(BintreeNodes& nodes, int32_t i, int level, Random& jitter,
                 BintreePending& pending) {
  if (nodes[i].level == level) {
    pending.push_back(i);
    return;
  }
  nodes.split(i, jitter);
  plant_under(nodes, nodes.first_child(i), level, jitter, pending);
  plant_under(nodes, nodes.first_child(i) + 1, level, jitter, pending);
}

}  // namespace

void plant(BintreeNodes& nodes, int level, Random& jitter, BintreePending& pending) {
  nodes.reset(jitter.next_vec2());
  pending.clear();
  plant_under(nodes, BintreeNodes::root, level, jitter, pending);
}

int32_t choose_only_penumbra(const BintreeNodes& nodes, int32_t a, int32_t b) {
  const bool is_a = nodes[a].flag == ShadowFlag::penumbra;
  const bool is_b = nodes[b].flag == ShadowFlag::penumbra;
  return is_a == is_b ? -1 : is_a ? a : b;
}

int32_t choose_fewer_samples(const BintreeNodes& nodes, int32_t a, int32_t b) {
  return nodes[b].samples < nodes[a].samples ? b : a;
}

bool differs_from_neighbours(const BintreeNodes& nodes, int32_t i) {
  const int32_t sibling = nodes.sibling(i);
  for (const BintreeSide side : bintree_sides) {
    const int32_t n = nodes.neighbour(i, side);
    if (n >= 0 && n != sibling && nodes[n].flag != nodes[i].flag) return true;
  }
  return false;
}

int32_t choose_by_neighbours(const BintreeNodes& nodes, int32_t a, int32_t b) {
  const bool is_a = differs_from_neighbours(nodes, a), is_b = differs_from_neighbours(nodes, b);
  return is_a == is_b ? choose_fewer_samples(nodes, a, b) : is_a ? a : b;
}

int32_t choose_leaf(const BintreeNodes& nodes) {
  int32_t i = BintreeNodes::root;
  while (!nodes[i].is_leaf()) {
    const int32_t a = nodes.first_child(i), b = a + 1;
    if (const int32_t only = choose_only_penumbra(nodes, a, b); only >= 0) {
      i = only;
    } else if (nodes[a].flag == ShadowFlag::penumbra) {
      i = choose_fewer_samples(nodes, a, b);
    } else {
      i = choose_by_neighbours(nodes, a, b);
    }
  }
  return i;
}

int32_t choose_leaf_evenly(const BintreeNodes& nodes) {
  int32_t i = BintreeNodes::root;
  while (!nodes[i].is_leaf()) {
    i = choose_fewer_samples(nodes, nodes.first_child(i), nodes.first_child(i) + 1);
  }
  return i;
}

int32_t split_pending(BintreeNodes& nodes, int32_t leaf, Random& jitter, BintreePending& pending) {
  const int32_t empty = nodes.split(leaf, jitter);
  std::replace(pending.begin(), pending.end(), leaf, nodes.sibling(empty));
  pending.push_back(empty);
  return empty;
}

void enforce_level_difference(BintreeNodes& nodes, int32_t node, int difference, size_t most_leaves,
                              size_t& leaves, Random& jitter, BintreePending& pending,
                              std::vector<int32_t>& stack) {
  stack.clear();
  nodes.for_each_leaf([&](int32_t leaf) { stack.push_back(leaf); }, node);
  while (!stack.empty() && leaves < most_leaves) {
    const int32_t i = stack.back();
    stack.pop_back();
    if (!nodes[i].is_leaf()) continue;  // has been split; its leaves are on the stack
    const int level = nodes[i].level;
    for (const BintreeSide side : bintree_sides) {
      int32_t n = nodes.neighbour(i, side);
      while (n >= 0 && nodes[n].is_leaf() && nodes[n].level < level - difference &&
             leaves < most_leaves) {
        split_pending(nodes, n, jitter, pending);
        ++leaves;
        // the halves may now lie too deep beside other leaves
        stack.insert(stack.end(), {nodes.first_child(n), nodes.first_child(n) + 1});
        n = nodes.neighbour(i, side);
      }
    }
  }
}

int largest_level_difference(const BintreeNodes& nodes) {
  int largest = 0;
  nodes.for_each_leaf([&](int32_t i) {
    for (const BintreeSide side : bintree_sides) {
      const int32_t n = nodes.neighbour(i, side);
      if (n >= 0 && nodes[n].is_leaf())
        largest = std::max(largest, nodes[i].level - nodes[n].level);
    }
  });
  return largest;
}

namespace {

// [reuse] True if a child of a uniform node can become a leaf: it has two leaves below it, and
// would not lie too far above a neighbour.
bool can_become_leaf(const BintreeNodes& nodes, int32_t i, int difference) {
  const BintreeNode& n = nodes[i];
  if (!nodes[n.first_child].is_leaf() || !nodes[n.first_child + 1].is_leaf()) return false;
  return std::all_of(bintree_sides.begin(), bintree_sides.end(), [&](BintreeSide side) {
    const int32_t other = nodes.neighbour(i, side);
    return other < 0 || nodes.deepest_along(other, opposite(side)) <= n.level + difference;
  });
}

// Lists inner nodes level by level from the root. The order does not depend on storage.
void list_inner(const BintreeNodes& nodes, std::vector<int32_t>& out) {
  out.clear();
  if (!nodes[BintreeNodes::root].is_leaf()) out.push_back(BintreeNodes::root);
  for (size_t k = 0; k < out.size(); ++k) {
    const int32_t first = nodes.first_child(out[k]);
    for (const int32_t child : {first, first + 1})
      if (!nodes[child].is_leaf()) out.push_back(child);
  }
}

}  // namespace

void shrink(BintreeNodes& nodes, int initial_level, int difference, Random& coin,
            std::vector<int32_t>& order) {
  list_inner(nodes, order);
  // Under a uniform root all nodes go, level after level, so no neighbour is in the way.
  const bool is_uniform = difference > 0 && nodes[BintreeNodes::root].flag != ShadowFlag::penumbra;
  // Deepest first: only deeper neighbours can keep a node from becoming a leaf, and those have had
  // their turn.
  for (size_t k = order.size(); k-- > 0;) {
    const BintreeNode& n = nodes[order[k]];
    if (n.level < initial_level || n.parent < 0) continue;
    if (nodes[n.parent].flag == ShadowFlag::penumbra) continue;
    if (is_uniform || can_become_leaf(nodes, order[k], difference)) nodes.merge(order[k], coin);
  }
  nodes.propagate_all();
}

}  // namespace troffer
