#include "certified/light_groups.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "base/box.h"
#include "base/simd.h"
#include "base/units.h"

namespace troffer {

namespace {

// Returns the sine of the largest angle between a normal and the unit vector `mean`, rounded up.
// Returns 0 for equal normals, and 1 for an angle of 90° or more.
float spread_about(const LightPrimitives& all, std::span<const uint32_t> primitives,
                   const Vec3d& mean) {
  double least = 1;
  for (const uint32_t i : primitives) least = std::min(least, dot(all[i].normal, mean));
  if (!(least > 0)) return 1;
  const double sine = std::sqrt(std::max(1 - least * least, 0.0));
  return sine < 1e-5 ? 0.0f : float(sine) + 1e-5f;
}

}  // namespace

void LightGroups::add(const LightPrimitives& all, std::span<const uint32_t> primitives,
                      uint32_t first_source, uint32_t last_source) {
  LightGroup g{first_source, last_source, uint32_t(primitives_.size()), 0};
  Box box;
  Vec3d normal;
  bool is_two_sided = false;
  float area = 0, strength = 0;
  for (const uint32_t i : primitives) {
    const LightPrimitive& p = all[i];
    box.grow(p.bounds);
    normal = normal + p.normal * double(p.area);
    is_two_sided = is_two_sided || p.is_two_sided;
    area += p.area;
    const float seen = p.shape == PrimitiveShape::sphere ? 0.25f * p.area : p.area;
    strength += luminance(p.mean_radiance) * seen;
    primitives_.push_back(i);
    areas_.push_back(area);
  }
  g.last_primitive = uint32_t(primitives_.size());
  groups_.push_back(g);
  with_sources_ += first_source < last_source ? 1 : 0;
  normal = length(normal) > 1e-6 * double(area) ? normalize(normal) : Vec3d();
  const float spread = spread_about(all, primitives, normal);
  if (!(spread < 1) || (is_two_sided && spread > 0)) normal = {};
  const Vec3 centre = box.centre(), n(normal);
  arrays_.add(centre, 0.5f * box.diagonal(), n, spread, is_two_sided ? 1.0f : 0.0f, strength);
}

void LightGroups::Arrays::add(const Vec3& centre, float r, const Vec3& normal, float sine,
                              float both_sides, float light) {
  x.push_back(centre.x);
  y.push_back(centre.y);
  z.push_back(centre.z);
  radius.push_back(r);
  nx.push_back(normal.x);
  ny.push_back(normal.y);
  nz.push_back(normal.z);
  spread.push_back(sine);
  two_sided.push_back(both_sides);
  strength.push_back(light);
}

namespace {

// Spreads the ten bits of v to every third bit of the result.
uint32_t spread_bits(uint32_t v) {
  v = (v | v << 16) & 0x030000ffu;
  v = (v | v << 8) & 0x0300f00fu;
  v = (v | v << 4) & 0x030c30c3u;
  return (v | v << 2) & 0x09249249u;
}

template <class T>
void permute(const std::vector<uint32_t>& order, std::vector<T>& values) {
  std::vector<T> moved;
  moved.reserve(values.size());
  for (const uint32_t i : order) moved.push_back(values[i]);
  values = std::move(moved);
}

}  // namespace

void LightGroups::finish() {
  Box box;
  for (uint32_t i = 0; i < size(); ++i) box.grow({arrays_.x[i], arrays_.y[i], arrays_.z[i]});
  const Vec3 e = box.extent();
  const float longest = std::max({e.x, e.y, e.z, 1e-30f});
  std::vector<uint32_t> keys(size()), order(size());
  const auto cell = [&](float v, float lower) {
    return spread_bits(uint32_t(std::clamp((v - lower) / longest * 1023.0f, 0.0f, 1023.0f)));
  };
  for (uint32_t i = 0; i < size(); ++i)
    keys[i] = cell(arrays_.x[i], box.lower.x) | cell(arrays_.y[i], box.lower.y) << 1 |
              cell(arrays_.z[i], box.lower.z) << 2;
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(),
            [&](uint32_t a, uint32_t b) { return keys[a] != keys[b] ? keys[a] < keys[b] : a < b; });
  permute(order, groups_);
  for (auto* a : {&arrays_.x, &arrays_.y, &arrays_.z, &arrays_.radius, &arrays_.nx, &arrays_.ny,
                  &arrays_.nz, &arrays_.spread, &arrays_.two_sided, &arrays_.strength})
    permute(order, *a);
  take_together();
}

// Merges neighbouring groups. A merged group emits in all directions if its normals differ by 90°
// or more, or if a group of several emits both ways.
void LightGroups::take_together() {
  const size_t n = size(), parts = std::min<size_t>(n, most_taken_together);
  for (size_t part = 0; part < parts; ++part) {
    const size_t first = part * n / parts, last = (part + 1) * n / parts;
    Vec3 centre, normal;
    float strength = 0, both_sides = arrays_.two_sided[first];
    for (size_t i = first; i < last; ++i) {
      strength += arrays_.strength[i];
      centre += arrays_.centre(i) * arrays_.strength[i];
      normal += arrays_.normal(i) * arrays_.strength[i];
    }
    centre = strength > 0 ? centre * (1 / strength) : arrays_.centre(first);
    const float turned = length(normal);
    normal = turned > 1e-3f * strength ? normal * (1 / turned) : Vec3{};
    float radius = 0, spread = 0;
    for (size_t i = first; i < last; ++i) {
      radius = std::max(radius, length(arrays_.centre(i) - centre) + arrays_.radius[i]);
      const float cosine = dot(arrays_.normal(i), normal);
      const float sine = std::sqrt(std::max(1 - sqr(cosine), 0.0f)) + arrays_.spread[i];
      spread = std::max(spread, cosine > 0 ? sine : 1.0f);
      if (last > first + 1 && arrays_.two_sided[i] > 0) spread = 1;
    }
    if (!(spread < 1)) {
      normal = {};
      spread = 1;
      both_sides = 0;
    }
    together_.add(centre, radius, normal, spread, both_sides, strength);
  }
}

uint32_t LightGroups::choose_primitive(uint32_t group, float& u, float& pmf) const {
  const LightGroup& g = groups_[group];
  pmf = 1;
  if (g.last_primitive - g.first_primitive == 1) return primitives_[g.first_primitive];
  const float all = areas_[g.last_primitive - 1], target = u * all;
  const auto begin = areas_.begin() + g.first_primitive,
             end = areas_.begin() + g.last_primitive - 1;
  const auto i = uint32_t(std::upper_bound(begin, end, target) - areas_.begin());
  const float before = i == g.first_primitive ? 0.0f : areas_[i - 1];
  const float own = areas_[i] - before;
  u = std::clamp((target - before) / own, 0.0f, one_minus_epsilon);
  pmf = own / all;
  return primitives_[i];
}

namespace {

// Smallest effective cosine, relative to the largest cosine within the balls. It accounts for
// receivers that see more of the light than the ball's centre does.
constexpr float least_of_cosine = 0.1f;

// Estimates all groups for one ball. The cosines are those of the two centres, raised towards the
// largest that any receiver may see.
TROFFER_MULTIVERSION
void estimate_all(size_t n, const float* __restrict x, const float* __restrict y,
                  const float* __restrict z, const float* __restrict radius,
                  const float* __restrict nx, const float* __restrict ny,
                  const float* __restrict nz, const float* __restrict spread,
                  const float* __restrict two_sided, const float* __restrict strength,
                  const ClusterBall& ball, float* __restrict values, float* __restrict near) {
  const float cx = ball.centre.x, cy = ball.centre.y, cz = ball.centre.z, r = ball.radius;
  const float bx = ball.normal.x, by = ball.normal.y, bz = ball.normal.z;
  const float is_flat = bx * bx + by * by + bz * bz > 0 ? 1.0f : 0.0f;
  const float depth = ball.depth;
  for (size_t i = 0; i < n; ++i) {
    const float dx = x[i] - cx, dy = y[i] - cy, dz = z[i] - cz;
    const float d2 = dx * dx + dy * dy + dz * dz;
    const float both = radius[i] + r;
    const float wide2 = d2 + 0.25f * both * both + 1e-30f;
    const float distance = std::sqrt(wide2);
    // Normals and heights are common to all receivers only up to rounding.
    const float slack = 1e-4f * (distance + both);
    const float rise = is_flat > 0 ? bx * dx + by * dy + bz * dz : distance;
    const float top = rise + radius[i] + depth + slack;
    const float along = -(nx[i] * dx + ny[i] * dy + nz[i] * dz);
    const float turned = two_sided[i] > 0 ? std::abs(along) : along;
    const float has_normal = nx[i] * nx[i] + ny[i] * ny[i] + nz[i] * nz[i];
    const float over = has_normal > 0 ? turned : distance;
    // Normals differ from their mean by at most `spread`, and points of the group lie up to
    // `radius` higher.
    const float sine = spread[i], cosine = std::sqrt(std::max(1 - sine * sine, 0.0f));
    const float rounded = sine > 0 ? sine * distance + radius[i] : 0.0f;
    const float far = over * cosine + rounded + r + slack;
    const float at_receiver = std::max(rise, least_of_cosine * top) / distance;
    const float at_source = std::max(over, least_of_cosine * far) / distance;
    const float cosines = std::min(at_receiver, 1.0f) * std::min(at_source, 1.0f);
    const float value = top > 0 && far > 0 ? strength[i] * cosines / wide2 : 0.0f;
    values[i] = value;
    near[i] = d2 < 16 * r * r ? value : 0.0f;
  }
}

}  // namespace

void LightGroups::estimate(const Arrays& a, const ClusterBall& ball, float* values, float* near) {
  estimate_all(a.size(), a.x.data(), a.y.data(), a.z.data(), a.radius.data(), a.nx.data(),
               a.ny.data(), a.nz.data(), a.spread.data(), a.two_sided.data(), a.strength.data(),
               ball, values, near);
}

void LightGroups::estimate(const ClusterBall& ball, std::vector<float>& values,
                           std::vector<float>& near) const {
  values.resize(size());
  near.resize(size());
  estimate(arrays_, ball, values.data(), near.data());
}

float LightGroups::all_light(const Vec3& x, const Vec3& n) const {
  std::array<float, most_taken_together> values{}, near{};
  estimate(together_, {x, 0, n, 0}, values.data(), near.data());
  return std::accumulate(values.begin(), values.begin() + std::ptrdiff_t(together_.size()), 0.0f);
}

}  // namespace troffer
