#include "select/light_tree_builder.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "base/units.h"

namespace troffer {

namespace {

// A cone of directions. cos_spread: 1 for the axis alone, -1 for all directions.
struct Cone {
  Vec3 axis{0, 0, 1};
  float cos_spread = 1;
  bool is_empty = true;
};

// Returns the smallest cone that contains both [2].
Cone merge(const Cone& a, const Cone& b) {
  if (a.is_empty) return b;
  if (b.is_empty) return a;
  const float cos_between = dot(a.axis, b.axis);
  // A single direction inside a cone is the usual case in a large set.
  if (b.cos_spread >= 1 && cos_between >= a.cos_spread) return a;
  const float spread_a = std::acos(std::clamp(a.cos_spread, -1.0f, 1.0f));
  const float spread_b = std::acos(std::clamp(b.cos_spread, -1.0f, 1.0f));
  const float between = std::acos(std::clamp(cos_between, -1.0f, 1.0f));
  if (std::min(between + spread_b, pi_f) <= spread_a) return a;
  if (std::min(between + spread_a, pi_f) <= spread_b) return b;
  const float spread = (spread_a + between + spread_b) / 2;
  const Cone all{{0, 0, 1}, -1, false};
  if (spread >= pi_f) return all;
  const Vec3 turn = cross(a.axis, b.axis);
  const float turn_length = length(turn);
  if (!(turn_length > 1e-7f)) return between < 1 ? a : all;
  // Rotate a's axis towards b's until the merged cone just contains a.
  const float angle = spread - spread_a;
  const Vec3 k = turn / turn_length;
  const Vec3 axis = a.axis * std::cos(angle) + cross(k, a.axis) * std::sin(angle);
  return {normalize(axis), std::cos(spread), false};
}

// Measure of the directions lit by a cone of diffuse lights [1, Eq. 1, with 90 degrees].
float orientation_measure(const Cone& c) {
  const float spread = std::acos(std::clamp(c.cos_spread, -1.0f, 1.0f));
  const float reach = std::min(spread + pi_f / 2, pi_f);
  const float sin_spread = std::sin(spread);
  return 2 * pi_f * (1 - c.cos_spread) +
         pi_f / 2 *
             (2 * reach * sin_spread - std::cos(spread - 2 * reach) - 2 * spread * sin_spread +
              c.cos_spread);
}

float surface_measure(const Box& b) {
  const Vec3 e = b.extent();
  return 2 * (e.x * e.y + e.y * e.z + e.z * e.x);
}

// Bins per axis when a split is searched.
constexpr size_t split_bins = 12;
// Depth of the binary tree from which sets are split into equal halves, to bound the recursion.
constexpr int balanced_depth = 32;

}  // namespace

struct LightTreeBuilder::Item {
  uint32_t primitive;
  Box bounds;
  Vec3 centre;
  Cone cone;
  float power;
  bool is_two_sided;
};

// Combined bounds, cone and power of a set of items.
struct LightTreeBuilder::Summary {
  Box bounds, centres;
  Cone cone;
  float power = 0;
  bool is_two_sided = false;

  void add(const Item& i) {
    bounds.grow(i.bounds);
    centres.grow(i.centre);
    cone = merge(cone, i.cone);
    power += i.power;
    is_two_sided = is_two_sided || i.is_two_sided;
  }
  void add(const Summary& s) {
    bounds.grow(s.bounds);
    centres.grow(s.centres);
    cone = merge(cone, s.cone);
    power += s.power;
    is_two_sided = is_two_sided || s.is_two_sided;
  }
  // Cost by the surface area orientation heuristic [1, Eq. 2].
  float cost() const {
    return power > 0 ? power * orientation_measure(cone) * surface_measure(bounds) : 0;
  }
};

struct LightTreeBuilder::BinaryNode {
  Summary summary;
  uint32_t first_child = 0, second_child = 0;  // 0: a leaf
  uint32_t primitive = 0;
};

LightTreeBuilder::LightTreeBuilder(const LightPrimitives& primitives, LightPrimitives::Range range,
                                   LightTree& tree)
    : tree_(tree) {
  items_.reserve(range.last - range.first);
  for (uint32_t i = range.first; i < range.last; ++i) {
    const LightPrimitive& p = primitives[i];
    if (p.is_infinite() || !(p.tree_power > 0) || !std::isfinite(p.tree_power)) continue;
    const Cone cone{p.cone_axis, p.cos_cone, false};
    items_.push_back({i, p.bounds, p.bounds.centre(), cone, p.tree_power, p.is_two_sided});
  }
  if (items_.empty()) return;
  binary_.reserve(items_.size() * 2);
  build_binary(0, items_.size(), 0);
  collapse(0);
}

LightTreeBuilder::~LightTreeBuilder() = default;

uint32_t LightTreeBuilder::build_binary(size_t first, size_t last, int depth) {
  Summary all;
  for (size_t i = first; i < last; ++i) all.add(items_[i]);
  const auto index = uint32_t(binary_.size());
  binary_.push_back({all, 0, 0, items_[first].primitive});
  if (last - first == 1) return index;
  const size_t middle = split(all, first, last, depth);
  const uint32_t a = build_binary(first, middle, depth + 1);
  const uint32_t b = build_binary(middle, last, depth + 1);
  binary_[index].first_child = a;
  binary_[index].second_child = b;
  return index;
}

// Partitions items [first, last) and returns where the second part begins. Takes the best split of
// the centres into bins along any axis, with costs relative to the longest side [1, section 4.4].
size_t LightTreeBuilder::split(const Summary& all, size_t first, size_t last, int depth) {
  size_t best_axis = 3, best_bin = 0;
  float best_cost = std::numeric_limits<float>::infinity();
  const Vec3 extent = all.centres.extent();
  const float longest = std::max(extent.x, std::max(extent.y, extent.z));
  const auto bin_of = [&](const Item& item, size_t axis) {
    const float t = (item.centre[axis] - all.centres.lower[axis]) / extent[axis];
    return std::min(split_bins - 1, size_t(std::max(0.0f, t * float(split_bins))));
  };
  for (size_t axis = 0; axis < 3; ++axis) {
    if (!(extent[axis] > 0)) continue;
    std::array<Summary, split_bins> bins;
    for (size_t i = first; i < last; ++i) bins[bin_of(items_[i], axis)].add(items_[i]);
    std::array<float, split_bins> below{};
    Summary sum;
    for (size_t b = 0; b + 1 < split_bins; ++b) {
      if (bins[b].power > 0) sum.add(bins[b]);
      below[b] = sum.cost();
    }
    sum = {};
    for (size_t b = split_bins - 1; b > 0; --b) {
      if (bins[b].power > 0) sum.add(bins[b]);
      const float cost = (below[b - 1] + sum.cost()) * longest / extent[axis];
      if (cost < best_cost) {
        best_cost = cost;
        best_axis = axis;
        best_bin = b;
      }
    }
  }
  const auto begin = items_.begin() + std::ptrdiff_t(first);
  const auto end = items_.begin() + std::ptrdiff_t(last);
  auto middle = begin;
  if (best_axis < 3 && depth < balanced_depth)
    middle =
        std::partition(begin, end, [&](const Item& i) { return bin_of(i, best_axis) < best_bin; });
  if (middle == begin || middle == end) middle = begin + (end - begin) / 2;
  return size_t(middle - items_.begin());
}

void LightTreeBuilder::set_lane(LightTree::Node& node, uint32_t slot, const Summary& s) {
  const Vec3 c = s.bounds.centre();
  node.centre_x[slot] = c.x;
  node.centre_y[slot] = c.y;
  node.centre_z[slot] = c.z;
  node.radius_squared[slot] = length_squared(s.bounds.extent() * 0.5f);
  node.axis_x[slot] = s.cone.axis.x;
  node.axis_y[slot] = s.cone.axis.y;
  node.axis_z[slot] = s.cone.axis.z;
  node.cos_spread[slot] = s.cone.cos_spread;
  node.sin_spread[slot] = std::sqrt(std::max(0.0f, 1 - s.cone.cos_spread * s.cone.cos_spread));
  node.power[slot] = s.power;
  node.two_sided[slot] = s.is_two_sided ? 1.0f : 0.0f;
}

// Makes one wide node from a binary node and its descendants: replaces the strongest inner child by
// its two children until all slots are taken.
uint32_t LightTreeBuilder::collapse(uint32_t binary) {
  std::array<uint32_t, LightTree::width> children{binary};
  uint32_t count = 1;
  while (count < LightTree::width) {
    uint32_t strongest = LightTree::width;
    for (uint32_t c = 0; c < count; ++c) {
      const BinaryNode& b = binary_[children[c]];
      if (b.second_child != 0 && (strongest == LightTree::width ||
                                  b.summary.power > binary_[children[strongest]].summary.power))
        strongest = c;
    }
    if (strongest == LightTree::width) break;
    const BinaryNode& b = binary_[children[strongest]];
    children[strongest] = b.first_child;
    children[count++] = b.second_child;
  }
  const auto index = uint32_t(tree_.nodes_.size());
  tree_.nodes_.emplace_back();
  for (uint32_t c = 0; c < count; ++c) {
    const BinaryNode& b = binary_[children[c]];
    set_lane(tree_.nodes_[index], c, b.summary);
    uint32_t child = b.primitive;
    if (b.second_child != 0) {
      child = collapse(children[c]);
      tree_.nodes_[child].parent = index;
      tree_.nodes_[child].slot = c;
    } else {
      tree_.nodes_[index].is_leaf[c] = true;
      tree_.places_[b.primitive - tree_.first_] = {index, c};
    }
    tree_.nodes_[index].child[c] = child;
  }
  return index;
}

}  // namespace troffer
