#include "select/light_tree.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "base/units.h"

namespace troffer {

namespace {

// A cone of directions; cos_spread 1 = the axis alone, -1 = all directions.
struct Cone {
  Vec3 axis{0, 0, 1};
  float cos_spread = 1;
  bool is_empty = true;
};

// The smallest cone that holds both [2].
Cone merge(const Cone& a, const Cone& b) {
  if (a.is_empty) return b;
  if (b.is_empty) return a;
  const float spread_a = std::acos(std::clamp(a.cos_spread, -1.0f, 1.0f));
  const float spread_b = std::acos(std::clamp(b.cos_spread, -1.0f, 1.0f));
  const float between = std::acos(std::clamp(dot(a.axis, b.axis), -1.0f, 1.0f));
  if (std::min(between + spread_b, pi_f) <= spread_a) return a;
  if (std::min(between + spread_a, pi_f) <= spread_b) return b;
  const float spread = (spread_a + between + spread_b) / 2;
  const Cone all{{0, 0, 1}, -1, false};
  if (spread >= pi_f) return all;
  const Vec3 turn = cross(a.axis, b.axis);
  const float turn_length = length(turn);
  if (!(turn_length > 1e-7f)) return between < 1 ? a : all;
  // Turns a's axis towards b's by the angle at which the merged cone just holds a.
  const float angle = spread - spread_a;
  const Vec3 k = turn / turn_length;
  const Vec3 axis = a.axis * std::cos(angle) + cross(k, a.axis) * std::sin(angle);
  return {normalize(axis), std::cos(spread), false};
}

// Measure of the directions that a cone of diffuse emitters lights [1, Eq. 1, with 90 degrees].
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

// cos(max(0, a - b)) of angles in [0, pi] given by cosine and sine.
float cos_sub_clamped(float cos_a, float sin_a, float cos_b, float sin_b) {
  return cos_a > cos_b ? 1 : cos_a * cos_b + sin_a * sin_b;
}
float sin_sub_clamped(float cos_a, float sin_a, float cos_b, float sin_b) {
  return cos_a > cos_b ? 0 : sin_a * cos_b - cos_a * sin_b;
}
float sin_from_cos(float c) {
  return std::sqrt(std::max(0.0f, 1 - c * c));
}

}  // namespace

struct LightTree::Item {
  uint32_t primitive;
  Box bounds;
  Vec3 centre;
  Cone cone;
  float power;
  bool is_two_sided;
};

namespace {

// What a set of items amounts to.
struct Summary {
  Box bounds, centres;
  Cone cone;
  float power = 0;
  bool is_two_sided = false;

  template <class Item>
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
  // The surface area orientation heuristic [1, Eq. 2].
  float cost() const {
    return power > 0 ? power * orientation_measure(cone) * surface_measure(bounds) : 0;
  }
};

constexpr size_t split_bins = 12;

}  // namespace

LightTree::LightTree(const LightPrimitives& primitives)
    : LightTree(primitives, {0, uint32_t(primitives.size())}) {}

LightTree::LightTree(const LightPrimitives& primitives, LightPrimitives::Range range)
    : first_(range.first) {
  trails_.assign(range.last - range.first, 0);
  std::vector<Item> items;
  items.reserve(trails_.size());
  for (uint32_t i = range.first; i < range.last; ++i) {
    const LightPrimitive& p = primitives[i];
    if (!(p.power > 0) || !std::isfinite(p.power)) continue;
    const Cone cone{p.cone_axis, p.cos_cone, false};
    items.push_back({i, p.bounds, p.bounds.centre(), cone, p.power, p.is_two_sided});
  }
  nodes_.reserve(items.size() * 2);
  if (!items.empty()) build(items, 0, items.size(), 0, 0);
}

uint32_t LightTree::build(std::vector<Item>& items, size_t first, size_t last, uint64_t trail,
                          int depth) {
  Summary all;
  for (size_t i = first; i < last; ++i) all.add(items[i]);
  const auto index = uint32_t(nodes_.size());
  nodes_.emplace_back();
  Node& node = nodes_.back();
  node.centre = all.bounds.centre();
  node.half_extent = all.bounds.extent() * 0.5f;
  node.radius_squared = length_squared(node.half_extent);
  node.axis = all.cone.axis;
  node.cos_spread = all.cone.cos_spread;
  node.is_two_sided = all.is_two_sided;
  node.power = all.power;
  if (last - first == 1) {
    node.primitive = items[first].primitive;
    trails_[node.primitive - first_] = trail;
    return index;
  }

  // Best split of the centres into bins along any axis, relative to the longest side [1, §4.4].
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
    for (size_t i = first; i < last; ++i) bins[bin_of(items[i], axis)].add(items[i]);
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
  const auto begin = items.begin() + std::ptrdiff_t(first),
             end = items.begin() + std::ptrdiff_t(last);
  auto middle = begin;
  // Trails hold 64 turns: below that depth halves keep the tree balanced.
  if (best_axis < 3 && depth < 32)
    middle =
        std::partition(begin, end, [&](const Item& i) { return bin_of(i, best_axis) < best_bin; });
  if (middle == begin || middle == end) middle = begin + (end - begin) / 2;
  const auto split = size_t(middle - items.begin());
  build(items, first, split, trail, depth + 1);
  const uint32_t second = build(items, split, last, trail | (uint64_t(1) << depth), depth + 1);
  nodes_[index].second_child = second;
  return index;
}

// Upper-bound-like estimate of what the node's primitives send to x [1, Eq. 3; 2]: power × cosine
// at the source × cosine at x / distance², each cosine the largest that bounds and cone allow.
float LightTree::importance(const Node& node, const Vec3& x, const Vec3& n, bool both_sides) {
  const Vec3 to_x = x - node.centre;
  const float d2 = length_squared(to_x);
  // Inside or close to the bounds nothing is known of directions.
  const float floor_d2 = std::max(d2, node.radius_squared);
  if (d2 <= node.radius_squared * 1.0001f || d2 == 0)
    return node.power / std::max(floor_d2, std::numeric_limits<float>::min());

  const Vec3 w = to_x * (1 / std::sqrt(d2));
  // Angle under which the sphere around the bounds is seen.
  const float sin2_bounds = node.radius_squared / d2;
  const float cos_bounds = std::sqrt(std::max(0.0f, 1 - sin2_bounds));
  const float sin_bounds = std::sqrt(sin2_bounds);

  float cos_axis = dot(w, node.axis);
  if (node.is_two_sided) cos_axis = std::abs(cos_axis);
  const float sin_axis = sin_from_cos(cos_axis), sin_spread = sin_from_cos(node.cos_spread);
  const float cos_past_cone = cos_sub_clamped(cos_axis, sin_axis, node.cos_spread, sin_spread);
  const float sin_past_cone = sin_sub_clamped(cos_axis, sin_axis, node.cos_spread, sin_spread);
  const float cos_source = cos_sub_clamped(cos_past_cone, sin_past_cone, cos_bounds, sin_bounds);
  if (cos_source <= 0) return 0;

  float cos_x = -dot(w, n);
  if (both_sides) cos_x = std::abs(cos_x);
  const float cos_receiver = cos_sub_clamped(cos_x, sin_from_cos(cos_x), cos_bounds, sin_bounds);
  if (cos_receiver <= 0) return 0;
  return node.power * cos_source * cos_receiver / floor_d2;
}

LightChoice LightTree::choose(const Vec3& x, const Vec3& n, bool both_sides, float u) const {
  if (nodes_.empty()) return {};
  float pmf = 1;
  uint32_t at = 0;
  while (nodes_[at].second_child != 0) {
    const uint32_t first = at + 1, second = nodes_[at].second_child;
    const float a = importance(nodes_[first], x, n, both_sides);
    const float b = importance(nodes_[second], x, n, both_sides);
    if (!(a + b > 0)) return {};
    const float share = a / (a + b);
    if (u < share) {
      at = first;
      pmf *= share;
      u = u / share;
    } else {
      at = second;
      pmf *= 1 - share;
      u = (u - share) / (1 - share);
    }
    u = std::min(u, one_minus_epsilon);
  }
  return {nodes_[at].primitive, pmf, u};
}

float LightTree::pmf(const Vec3& x, const Vec3& n, bool both_sides, uint32_t primitive) const {
  if (nodes_.empty()) return 0;
  float pmf = 1;
  uint32_t at = 0;
  for (uint64_t trail = trails_[primitive - first_]; nodes_[at].second_child != 0; trail >>= 1) {
    const uint32_t first = at + 1, second = nodes_[at].second_child;
    const float a = importance(nodes_[first], x, n, both_sides);
    const float b = importance(nodes_[second], x, n, both_sides);
    if (!(a + b > 0)) return 0;
    const float share = a / (a + b);
    const bool is_second = (trail & 1) != 0;
    at = is_second ? second : first;
    pmf *= is_second ? 1 - share : share;
  }
  return nodes_[at].primitive == primitive ? pmf : 0;
}

}  // namespace troffer
