#include "shadow/plan_rays.h"

#include <algorithm>
#include <cmath>

#include "shadow/mask_points.h"

namespace troffer {

namespace {

// Number of rays of one receiver above which a compact order pays off for ray packets.
constexpr uint32_t fewest_compact = 96;

// Returns the point where the segment from x to p first meets the sphere, or the nearest point if
// it misses.
Vec3 near_end(const RaySource& s, const Vec3& x, const Vec3& p) {
  const Vec3d d = normalize(Vec3d(p) - Vec3d(x)), to_centre = s.centre - Vec3d(x);
  const double along = dot(to_centre, d);
  const double half2 = s.radius * s.radius - length_squared(to_centre - d * along);
  return Vec3(Vec3d(x) + d * (along - std::sqrt(std::max(half2, 0.0))));
}

void add_segments(const Vec3& origin, const RaySource& source, std::span<const Vec3> points,
                  std::vector<ShadowSegment>& segments) {
  for (const Vec3& p : points)
    segments.push_back({origin, source.is_round ? near_end(source, origin, p) : p, source.own});
}

// Returns the number of rays that a pair's own visible share deserves.
float rays_for_share(float light, float unoccluded, const RayLimits& limits) {
  return std::min(sqr(0.5f * light / unoccluded / limits.pair_error), float(limits.most_pair_rays));
}

// Returns the number of rays of a pair. open, for_shares: sums over the pairs of its receiver.
uint32_t number_of_rays(const RayQueue::OpenPair& p, float brightness, float allowed, float open,
                        float for_shares, const RayLimits& limits) {
  // `all` is the real-valued number of rays of the receiver. Quotients come before squares, because
  // squares of brightness may overflow and may be zero.
  const float all = allowed > 0 ? sqr(open / (2 * allowed)) : float(limits.most_rays);
  const float own = brightness * p.light;
  const float share = own > 0 ? own / open : 0;
  const float wanted = share * std::min(all, float(limits.most_rays));
  // The limit is shared by all pairs, so one of hundreds of sources gets fewer rays than one of a
  // few.
  const float scale = std::min(float(limits.most_share_rays) / for_shares, 1.0f);
  const float for_share = rays_for_share(p.light, p.unoccluded, limits) * scale;
  return uint32_t(std::max(std::ceil(std::max(wanted, for_share) - 1e-3f), 1.0f));
}

}  // namespace

void plan_rays(const RayQueue& queue, std::span<const float> allowed, const RayLimits& limits,
               RayPlan& plan) {
  plan.groups.clear();
  plan.segments.clear();
  plan.open.assign(allowed.size(), 0);
  plan.for_shares.assign(allowed.size(), 0);
  for (const RayQueue::OpenPair& p : queue.open) {
    plan.open[p.member] += queue.sources[p.source].brightness * p.light;
    plan.for_shares[p.member] += rays_for_share(p.light, p.unoccluded, limits);
  }
  for (const RayQueue::OpenPair& p : queue.open) {
    const RaySource& source = queue.sources[p.source];
    const uint32_t n = number_of_rays(p, source.brightness, allowed[p.member], plan.open[p.member],
                                      plan.for_shares[p.member], limits);
    plan.points.clear();
    (n < fewest_compact ? draw_points : draw_points_compact)(queue.frames[p.frame], p.samples, n,
                                                             p.random, plan.points);
    plan.groups.push_back({p.member, p.source, uint32_t(plan.segments.size()),
                           uint32_t(plan.points.size()), p.frame, p.passes, false, 0, p.light});
    add_segments(p.origin, source, plan.points, plan.segments);
  }
  for (const RayQueue::PointPair& p : queue.by_points) {
    plan.groups.push_back({p.member, p.source, uint32_t(plan.segments.size()), p.count, 0, 1, true,
                           p.first, p.light, p.is_difference});
    add_segments(p.origin, queue.sources[p.source],
                 std::span(queue.points).subspan(p.first, p.count), plan.segments);
  }
}

}  // namespace troffer
