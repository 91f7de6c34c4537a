#include "select/light_tree.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/simd.h"
#include "base/units.h"
#include "select/light_tree_builder.h"

namespace troffer {

LightTree::LightTree(const LightPrimitives& primitives)
    : LightTree(primitives, {0, uint32_t(primitives.size())}) {}

LightTree::LightTree(const LightPrimitives& primitives, LightPrimitives::Range range)
    : first_(range.first), places_(range.last - range.first) {
  LightTreeBuilder(primitives, range, *this);
  for (const uint32_t i : primitives.at_infinity()) {
    if (i < range.first || i >= range.last) continue;
    const LightPrimitive& p = primitives[i];
    const float sin_spread = std::sqrt(std::max(0.0f, 1 - sqr(p.cos_cone)));
    places_[i - first_].slot = uint32_t(infinite_.size());
    infinite_.push_back({i, p.cone_axis, sin_spread, p.cos_cone <= 0});
  }
}

namespace {

// One child of a node: one lane of LightTree::Node.
struct Child {
  float centre_x, centre_y, centre_z, radius_squared, axis_x, axis_y, axis_z, cos_spread,
      sin_spread, power, two_sided;
};

// Estimates the light that a child's primitives send to a point; 0 only if they can send none [1,
// Eq. 3; 2]. It is power × cosine at the source × cosine at the point / distance², each cosine the
// largest that bounds and cone allow. Angles enter by sine and cosine only: cos(max(0, a - b)) is 1
// if cos a > cos b, else cos a cos b + sin a sin b. Branch-free, so that loops vectorize. sides: 1
// if light from behind (nx, ny, nz) counts too, else 0.
TROFFER_ALWAYS_INLINE float importance(const Child& c, float x, float y, float z, float nx,
                                       float ny, float nz, float sides) {
  constexpr float tiny = std::numeric_limits<float>::min();
  const float tx = x - c.centre_x, ty = y - c.centre_y, tz = z - c.centre_z;
  const float d2 = tx * tx + ty * ty + tz * tz;
  const float r2 = c.radius_squared;
  const float clear_d2 = std::max(std::max(d2, r2), tiny);
  const float scale = 1 / std::sqrt(std::max(d2, tiny));
  // Angular radius of the sphere around the bounds.
  const float sin2_bounds = std::min(r2 / std::max(d2, tiny), 1.0f);
  const float cos_bounds = std::sqrt(1 - sin2_bounds), sin_bounds = std::sqrt(sin2_bounds);

  const float axis = (tx * c.axis_x + ty * c.axis_y + tz * c.axis_z) * scale;
  const float cos_axis = std::max(axis, -axis * c.two_sided - (1 - c.two_sided));
  const float sin_axis = std::sqrt(std::max(0.0f, 1 - cos_axis * cos_axis));
  const float cs = c.cos_spread, ss = c.sin_spread;
  const float cos_past = cos_axis > cs ? 1 : cos_axis * cs + sin_axis * ss;
  const float sin_past = cos_axis > cs ? 0 : sin_axis * cs - cos_axis * ss;
  const float cos_source =
      cos_past > cos_bounds ? 1 : cos_past * cos_bounds + sin_past * sin_bounds;

  const float towards = -(tx * nx + ty * ny + tz * nz) * scale;
  const float cos_x = std::max(towards, -towards * sides - (1 - sides));
  const float sin_x = std::sqrt(std::max(0.0f, 1 - cos_x * cos_x));
  const float cos_receiver = cos_x > cos_bounds ? 1 : cos_x * cos_bounds + sin_x * sin_bounds;

  // Inside the sphere around the bounds, the directions are unknown.
  const float cosines =
      d2 <= r2 * 1.0001f ? 1.0f : std::max(0.0f, cos_source) * std::max(0.0f, cos_receiver);
  return c.power * cosines / clear_d2;
}

// Importances of one child for n points.
TROFFER_MULTIVERSION
void importances_of_child(const Child& child, size_t n, const float* __restrict x,
                          const float* __restrict y, const float* __restrict z,
                          const float* __restrict nx, const float* __restrict ny,
                          const float* __restrict nz, const float* __restrict sides,
                          float* __restrict out) {
  const Child c = child;
  for (size_t i = 0; i < n; ++i)
    out[i] = importance(c, x[i], y[i], z[i], nx[i], ny[i], nz[i], sides[i]);
}

}  // namespace

// Importances of all children of a node for one point.
void LightTree::importances(const Node& node, const Vec3& x, const Vec3& n, bool both_sides,
                            Lanes& out) {
  const float sides = both_sides ? 1.0f : 0.0f;
  for (uint32_t k = 0; k < width; ++k)
    out[k] = importance({node.centre_x[k], node.centre_y[k], node.centre_z[k],
                         node.radius_squared[k], node.axis_x[k], node.axis_y[k], node.axis_z[k],
                         node.cos_spread[k], node.sin_spread[k], node.power[k], node.two_sided[k]},
                        x.x, x.y, x.z, n.x, n.y, n.z, sides);
}

// Picks a child in proportion to `weight`, and updates pmf and u. Returns `width` if all weights
// are 0.
uint32_t LightTree::pick(const Lanes& weight, float& pmf, float& u) {
  const Lanes below{0, weight[0], weight[0] + weight[1], weight[0] + weight[1] + weight[2]};
  const float total = below[3] + weight[3];
  if (!(total > 0)) return width;
  const float target = u * total;
  // Counts instead of branching, because the outcome is unpredictable.
  uint32_t k =
      uint32_t(target >= below[1]) + uint32_t(target >= below[2]) + uint32_t(target >= below[3]);
  while (weight[k] == 0) --k;  // rounding may run past the last child with a weight
  pmf *= weight[k] / total;
  u = std::clamp((target - below[k]) / weight[k], 0.0f, one_minus_epsilon);
  return k;
}

LightChoice LightTree::choose_below(uint32_t at, const Vec3& x, const Vec3& n, bool both_sides,
                                    float pmf, float u) const {
  while (true) {
    const Node& node = nodes_[at];
    alignas(16) Lanes weight;
    importances(node, x, n, both_sides, weight);
    const uint32_t k = pick(weight, pmf, u);
    if (k == width) return {};
    if (node.is_leaf[k]) return {node.child[k], pmf, u};
    at = node.child[k];
  }
}

// Sum of the weights of the tree and the lights at infinity: 1 for each that may light the point.
float LightTree::weight_sum(const Vec3& x, const Vec3& n, bool both_sides) const {
  float sum = 0;
  if (!nodes_.empty()) {
    alignas(16) Lanes weight;
    importances(nodes_[0], x, n, both_sides, weight);
    sum = (weight[0] + weight[1]) + (weight[2] + weight[3]) > 0 ? 1.0f : 0.0f;
  }
  for (const Infinite& i : infinite_) sum += i.may_light(n, both_sides) ? 1.0f : 0.0f;
  return sum;
}

// Picks a light at infinity. Returns false if the tree should choose, or nothing can; then `choice`
// holds the remaining random number and the tree's probability.
bool LightTree::choose_infinite(const Vec3& x, const Vec3& n, bool both_sides,
                                LightChoice& choice) const {
  const float sum = weight_sum(x, n, both_sides);
  float target = choice.u * sum;
  for (const Infinite& i : infinite_) {
    if (!i.may_light(n, both_sides)) continue;
    if (target < 1) {
      choice = {i.primitive, 1 / sum, target};
      return true;
    }
    target -= 1;
  }
  choice.u = std::min(target, one_minus_epsilon);
  choice.pmf = sum > 0 ? 1 / sum : 0;
  return false;
}

LightChoice LightTree::choose(const Vec3& x, const Vec3& n, bool both_sides, float u) const {
  LightChoice c{0, 1, u};
  if (!infinite_.empty() && choose_infinite(x, n, both_sides, c)) return c;
  return nodes_.empty() ? LightChoice{} : choose_below(0, x, n, both_sides, c.pmf, c.u);
}

float LightTree::chance_of_placed(const Vec3& x, const Vec3& n, bool both_sides) const {
  if (nodes_.empty()) return 0;
  alignas(16) Lanes weight;
  importances(nodes_[0], x, n, both_sides, weight);
  const bool may_light = (weight[0] + weight[1]) + (weight[2] + weight[3]) > 0;
  return may_light ? 1 / weight_sum(x, n, both_sides) : 0;
}

LightChoice LightTree::choose_placed(const Vec3& x, const Vec3& n, bool both_sides,
                                     float u) const {
  const float chance = chance_of_placed(x, n, both_sides);
  return chance > 0 ? choose_below(0, x, n, both_sides, chance, u) : LightChoice{};
}

// out[i] holds the probability and random number so far. Numbers increase, so each child takes a
// contiguous run of them.
void LightTree::choose_sorted_below(uint32_t at, const Vec3& x, const Vec3& n, bool both_sides,
                                    size_t count, LightChoice* out) const {
  const Node& node = nodes_[at];
  alignas(16) Lanes weight;
  importances(node, x, n, both_sides, weight);
  for (size_t i = 0; i < count;) {
    const uint32_t k = pick(weight, out[i].pmf, out[i].u);
    const size_t first = i++;
    if (k == width) {
      out[first] = {};
      continue;
    }
    while (i < count) {
      LightChoice next = out[i];
      if (pick(weight, next.pmf, next.u) != k) break;
      out[i++] = next;
    }
    if (!node.is_leaf[k])
      choose_sorted_below(node.child[k], x, n, both_sides, i - first, out + first);
    else
      for (size_t j = first; j < i; ++j) out[j].primitive = node.child[k];
  }
}

void LightTree::choose_sorted(const Vec3& x, const Vec3& n, bool both_sides, const float* u,
                              size_t count, LightChoice* out) const {
  for (size_t i = 0; i < count; ++i)
    out[i] = infinite_.empty() ? LightChoice{0, 1, u[i]} : choose(x, n, both_sides, u[i]);
  if (infinite_.empty() && !nodes_.empty())
    choose_sorted_below(0, x, n, both_sides, count, out);
  else if (nodes_.empty() && infinite_.empty())
    std::fill_n(out, count, LightChoice{});
}

void LightTree::choose_many(const LightReceivers& r, LightChoice* out,
                            std::vector<float>& scratch) const {
  const size_t n = r.size();
  if (nodes_.empty()) {
    for (size_t i = 0; i < n; ++i)
      out[i] = choose(r.position(i), r.normal(i), r.sides[i] != 0, r.u[i]);
    return;
  }
  // All points visit the root, so its children are evaluated for all points together.
  const Node& root = nodes_[0];
  scratch.resize(n * width);
  for (uint32_t k = 0; k < width; ++k)
    importances_of_child({root.centre_x[k], root.centre_y[k], root.centre_z[k],
                          root.radius_squared[k], root.axis_x[k], root.axis_y[k], root.axis_z[k],
                          root.cos_spread[k], root.sin_spread[k], root.power[k], root.two_sided[k]},
                         n, r.x.data(), r.y.data(), r.z.data(), r.nx.data(), r.ny.data(),
                         r.nz.data(), r.sides.data(), scratch.data() + k * n);
  for (size_t i = 0; i < n; ++i) {
    const Lanes weight{scratch[i], scratch[n + i], scratch[2 * n + i], scratch[3 * n + i]};
    const bool both_sides = r.sides[i] != 0;
    LightChoice& c = out[i] = {0, 1, r.u[i]};
    if (!infinite_.empty() && choose_infinite(r.position(i), r.normal(i), both_sides, c)) continue;
    const uint32_t k = pick(weight, c.pmf, c.u);
    if (k == width)
      c = {};
    else if (root.is_leaf[k])
      c.primitive = root.child[k];
    else
      c = choose_below(root.child[k], r.position(i), r.normal(i), both_sides, c.pmf, c.u);
  }
}

void LightTree::near_below(uint32_t at, const Vec3& x, float reach, size_t most,
                           std::vector<uint32_t>& out) const {
  const Node& node = nodes_[at];
  for (uint32_t k = 0; k < width && out.size() < most; ++k) {
    if (node.power[k] == 0) continue;
    const Vec3 d = x - Vec3(node.centre_x[k], node.centre_y[k], node.centre_z[k]);
    if (length_squared(d) > sqr(reach + std::sqrt(node.radius_squared[k]))) continue;
    if (node.is_leaf[k])
      out.push_back(node.child[k]);
    else
      near_below(node.child[k], x, reach, most, out);
  }
}

void LightTree::near(const Vec3& x, float reach, size_t most, std::vector<uint32_t>& out) const {
  out.clear();
  if (!nodes_.empty()) near_below(0, x, reach, most, out);
}

float LightTree::pmf(const Vec3& x, const Vec3& n, bool both_sides, uint32_t primitive) const {
  const Place place = places_[primitive - first_];
  if (place.node == no_node) {
    const bool is_beside = place.slot < infinite_.size() &&
                           infinite_[place.slot].primitive == primitive &&
                           infinite_[place.slot].may_light(n, both_sides);
    return is_beside ? 1 / weight_sum(x, n, both_sides) : 0;
  }
  float pmf = infinite_.empty() ? 1 : 1 / weight_sum(x, n, both_sides);
  for (uint32_t at = place.node, slot = place.slot;;) {
    const Node& node = nodes_[at];
    alignas(16) Lanes weight;
    importances(node, x, n, both_sides, weight);
    const float total = (weight[0] + weight[1] + weight[2]) + weight[3];
    if (!(weight[slot] > 0)) return 0;
    pmf *= weight[slot] / total;
    if (at == 0) return pmf;
    slot = node.slot;
    at = node.parent;
  }
}

}  // namespace troffer
