#include "integrate/weak_sources.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "base/random.h"

namespace troffer {

namespace {

// How many sources stand for the weak ones.
constexpr uint32_t draws = 8;
// With fewer sources there is nothing to gain.
constexpr size_t fewest_sources = 24;

}  // namespace

float unoccluded_bound(const CertifiedSource& s, const ClusterBall& ball, float& estimate) {
  Vec3 centre;
  float radius = 0, area = 0;
  if (s.is_round) {
    centre = Vec3(s.sphere.centre);
    radius = float(s.sphere.radius);
    area = pi_f * radius * radius;
  } else {
    const Parallelogram& p = s.flat.plane;
    centre = Vec3(p.origin + (p.u + p.v) * 0.5);
    radius = 0.5f * float(std::max(length(p.u + p.v), length(p.u - p.v)));
    area = float(length(cross(p.u, p.v)));
  }
  const Vec3 d = centre - ball.centre;
  const float distance = length(d), nearest = distance - radius - ball.radius;
  // Heights of the source over the receivers' horizon and of the receivers over its plane, at most;
  // where there is no common horizon a receiver may look straight at it.
  const bool is_flat = length_squared(ball.normal) > 0;
  const float rise = is_flat ? dot(ball.normal, d) : distance;
  const float over = s.is_round ? distance : -dot(Vec3(s.flat.plane.normal), d);
  const float highest = rise + radius + (is_flat ? ball.depth : ball.radius);
  const float farthest = over + ball.radius + (s.is_round ? radius : 0.0f);
  // normals and heights are common to all receivers within rounding
  const float slack = 1e-4f * (distance + radius + ball.radius);
  estimate = 0;
  if (highest < -slack || farthest < -slack) return 0;
  const float safe = std::max(distance, 1e-20f);
  estimate = std::min(pi_f, area * std::max(rise, 0.0f) * std::max(over, 0.0f) / sqr(sqr(safe)));
  if (s.is_round) estimate = std::min(pi_f, area * std::max(rise, 0.0f) / (safe * safe * safe));
  if (!(nearest > 0)) return pi_f;
  const float at_receiver = std::min(1.0f, std::max(highest, slack) / nearest);
  const float at_source = std::min(1.0f, std::max(farthest, slack) / nearest);
  return std::min(pi_f, area * at_receiver * at_source / (nearest * nearest));
}

void choose_sources(std::span<const CertifiedSource> sources, const ClusterBall& ball, float error,
                    uint64_t random, WeakSourcesScratch& s) {
  const auto n = uint32_t(sources.size());
  s.chosen.clear();
  s.weak.clear();
  if (n < fewest_sources) {
    for (uint32_t i = 0; i < n; ++i) s.chosen.push_back({i});
    return;
  }
  s.bounds.resize(n);
  s.order.clear();
  double all = 0;
  for (uint32_t i = 0; i < n; ++i) {
    const float brightness = luminance(sources[i].radiance);
    float estimate = 0;
    s.bounds[i] = brightness * unoccluded_bound(sources[i], ball, estimate);
    // what a texture shows has no unoccluded light in closed form
    if (sources[i].is_textured && s.bounds[i] > 0)
      s.bounds[i] = std::numeric_limits<float>::infinity();
    all += double(brightness * estimate);
    if (s.bounds[i] > 0) s.order.push_back(i);
  }
  std::sort(s.order.begin(), s.order.end(), [&](uint32_t a, uint32_t b) {
    return s.bounds[a] != s.bounds[b] ? s.bounds[a] < s.bounds[b] : a < b;
  });
  const double most = 2 * std::sqrt(double(draws)) * double(error) * all;
  double total = 0;
  uint32_t weak = 0;
  for (; weak < s.order.size(); ++weak) {
    const double with = total + double(s.bounds[s.order[weak]]);
    if (with > most) break;
    total = with;
  }
  if (weak <= 2 * draws) weak = 0;
  for (uint32_t i = weak; i < s.order.size(); ++i) s.chosen.push_back({s.order[i]});
  std::sort(s.chosen.begin(), s.chosen.end(),
            [](const ChosenSource& a, const ChosenSource& b) { return a.source < b.source; });
  if (weak == 0) return;
  // stratified sampling in proportion to the bounds: one draw from each of equal parts of the total
  const auto target = [&](uint32_t k) {
    const double u = double(mix64(random + k) >> 11) * 0x1p-53;
    return (double(k) + u) / draws * total;
  };
  s.weak.assign(s.order.begin(), s.order.begin() + weak);
  std::sort(s.weak.begin(), s.weak.end());
  double passed = 0;
  uint32_t next = 0;
  for (uint32_t i = 0; i < weak && next < draws; ++i) {
    const double bound = double(s.bounds[s.order[i]]);
    passed += bound;
    uint32_t times = 0;
    for (; next < draws && target(next) < passed; ++next) ++times;
    if (times > 0) s.chosen.push_back({s.order[i], times, float(times * total / (draws * bound))});
  }
}

}  // namespace troffer
