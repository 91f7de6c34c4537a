#include "select/light_tree.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/units.h"
#include "select/light_tree_builder.h"

namespace troffer {

LightTree::LightTree(const LightPrimitives& primitives)
    : LightTree(primitives, {0, uint32_t(primitives.size())}) {}

LightTree::LightTree(const LightPrimitives& primitives, LightPrimitives::Range range)
    : first_(range.first), places_(range.last - range.first) {
  LightTreeBuilder(primitives, range, *this);
}

// Estimate of what each child's primitives send to x, never 0 where they can send anything
// [1, Eq. 3; 2]: power × cosine at the source × cosine at x / distance², each cosine the largest
// that bounds and cone allow. Angles are known by sine and cosine only: cos(max(0, a - b)) is 1
// where cos a > cos b, else cos a cos b + sin a sin b. Without branches, so that all lanes go
// together.
void LightTree::importances(const Node& node, const Vec3& x, const Vec3& n, bool both_sides,
                            Lanes& out) {
  constexpr float tiny = std::numeric_limits<float>::min();
  const float receiver_sides = both_sides ? 1.0f : 0.0f;
  for (uint32_t k = 0; k < width; ++k) {
    const float tx = x.x - node.centre_x[k], ty = x.y - node.centre_y[k],
                tz = x.z - node.centre_z[k];
    const float d2 = tx * tx + ty * ty + tz * tz;
    const float r2 = node.radius_squared[k];
    const float clear_d2 = std::max(std::max(d2, r2), tiny);
    const float scale = 1 / std::sqrt(std::max(d2, tiny));
    // Angle under which the sphere around the bounds is seen.
    const float sin2_bounds = std::min(r2 / std::max(d2, tiny), 1.0f);
    const float cos_bounds = std::sqrt(1 - sin2_bounds), sin_bounds = std::sqrt(sin2_bounds);

    const float axis = (tx * node.axis_x[k] + ty * node.axis_y[k] + tz * node.axis_z[k]) * scale;
    const float cos_axis = std::max(axis, -axis * node.two_sided[k] - (1 - node.two_sided[k]));
    const float sin_axis = std::sqrt(std::max(0.0f, 1 - cos_axis * cos_axis));
    const float cs = node.cos_spread[k], ss = node.sin_spread[k];
    const float cos_past = cos_axis > cs ? 1 : cos_axis * cs + sin_axis * ss;
    const float sin_past = cos_axis > cs ? 0 : sin_axis * cs - cos_axis * ss;
    const float cos_source =
        cos_past > cos_bounds ? 1 : cos_past * cos_bounds + sin_past * sin_bounds;

    const float towards = -(tx * n.x + ty * n.y + tz * n.z) * scale;
    const float cos_x = std::max(towards, -towards * receiver_sides - (1 - receiver_sides));
    const float sin_x = std::sqrt(std::max(0.0f, 1 - cos_x * cos_x));
    const float cos_receiver = cos_x > cos_bounds ? 1 : cos_x * cos_bounds + sin_x * sin_bounds;

    // Inside the sphere around the bounds nothing is known of directions.
    const float cosines =
        d2 <= r2 * 1.0001f ? 1.0f : std::max(0.0f, cos_source) * std::max(0.0f, cos_receiver);
    out[k] = node.power[k] * cosines / clear_d2;
  }
}

LightChoice LightTree::choose(const Vec3& x, const Vec3& n, bool both_sides, float u) const {
  if (nodes_.empty()) return {};
  float pmf = 1;
  for (uint32_t at = 0;;) {
    const Node& node = nodes_[at];
    alignas(16) Lanes weight;
    importances(node, x, n, both_sides, weight);
    const Lanes below{0, weight[0], weight[0] + weight[1], weight[0] + weight[1] + weight[2]};
    const float total = below[3] + weight[3];
    if (!(total > 0)) return {};
    const float target = u * total;
    // Counted, not searched: which child it is cannot be predicted.
    uint32_t k = uint32_t(target >= below[1]) + uint32_t(target >= below[2]) +
                 uint32_t(target >= below[3]);
    while (weight[k] == 0) --k;  // rounding may run past the last one that counts
    pmf *= weight[k] / total;
    u = std::clamp((target - below[k]) / weight[k], 0.0f, one_minus_epsilon);
    if (node.is_leaf[k]) return {node.child[k], pmf, u};
    at = node.child[k];
  }
}

float LightTree::pmf(const Vec3& x, const Vec3& n, bool both_sides, uint32_t primitive) const {
  const Place place = places_[primitive - first_];
  if (place.node == no_node) return 0;
  float pmf = 1;
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
