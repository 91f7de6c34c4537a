// Spheres: seen from a point outside, a sphere of uniform radiance is the disk that its outline
// spans, and what hides the one hides the other. Each receiver has its own disk; lists of facets
// are shared by a cluster.
#include <algorithm>
#include <cmath>

#include "base/frame.h"
#include "base/random.h"
#include "light/irradiance.h"
#include "shadow/certified.h"

namespace troffer {

namespace {

// A square about the sphere's centre, across the line from the receivers, in which or before which
// every segment from them to the visible cap ends. Empty where the sphere is too near: no such
// square, or one much larger than the sphere.
struct RoundTarget {
  std::array<Vec3d, 4> corners;
  Vec3d normal;
  bool is_near = false;
};

RoundTarget target_of(const SphereSource& s, const ReceiverHull& hull) {
  double reach = hull.slack;
  for (int i = 0; i < hull.count; ++i)
    reach = std::max(reach, hull.slack + length(hull.corners[size_t(i)] - hull.centre));
  RoundTarget target;
  const Vec3d axis = s.centre - hull.centre;
  const double distance = length(axis);
  target.is_near = !(distance > reach + 1.05 * s.radius);
  if (target.is_near) return target;
  // Receivers lie in the ball of radius `reach` about the hull's centre: seen from the most unlucky
  // one the centre is off the axis by `off`, and a tangent of the sphere by `half` more.
  const double off = std::asin(reach / distance), half = std::asin(s.radius / (distance - reach));
  target.is_near = off + half > 1.2;
  if (target.is_near) return target;
  const double size = 1.0001 * (distance + reach) * (std::tan(off + half) - std::tan(off));
  const Framed frame(axis / distance);
  target.normal = -frame.normal;
  const Vec3d u = frame.tangent * size, v = frame.bitangent * size;
  target.corners = {s.centre - u - v, s.centre + u - v, s.centre + u + v, s.centre - u + v};
  return target;
}

// The disk that the sphere's outline spans from x, as its bounding square.
Parallelogram outline_of(const SphereSource& s, const Vec3d& x) {
  const Vec3d axis = s.centre - x;
  const double distance = length(axis), sine = s.radius / distance;
  const Framed frame(axis / distance);
  const double radius = s.radius * std::sqrt(std::max(1 - sine * sine, 0.0));
  const Vec3d centre = s.centre - frame.normal * (s.radius * sine);
  const Vec3d u = frame.tangent * (2 * radius), v = frame.bitangent * (2 * radius);
  return {centre - (u + v) * 0.5, u, v, -frame.normal};
}

// Whether a facet may reach into the sphere, where it would hide the disk but not the cap.
bool may_enter(const Quad& q, const SphereSource& s) {
  Vec3d lower(q[0]), upper = lower;
  for (const Vec3& v : q) {
    lower = min(lower, Vec3d(v));
    upper = max(upper, Vec3d(v));
  }
  const Vec3d nearest = max(lower, min(upper, s.centre));
  return length(nearest - s.centre) < s.radius * (1 + 1e-6);
}

}  // namespace

void CertifiedEstimator::settle_round(const SphereSource& source, std::span<const uint32_t> members,
                                      const ReceiverHull& hull) {
  std::vector<FacetToAdd>& facets = candidates_.facets;
  const size_t all = facets.size();
  std::erase_if(facets, [&](const FacetToAdd& f) { return may_enter(f.quad, source); });
  is_complete_ = is_complete_ && facets.size() == all;
  ++counters_.cells;
  for (const uint32_t m : members) {
    const bool is_mirrored = (mix64(cell_stream_ + receivers_[m].stream) & 1) != 0;
    const MaskFrame frame(outline_of(source, Vec3d(receivers_[m].position)), options_.lattice,
                          is_mirrored, hull.centre, {}, true);
    frame_ = &frame;
    FacetList& list = lists_[0];
    list.clear();
    if (is_complete_ && facets.empty() && !does_horizon_hide_) {
      add_lit(m);
      continue;
    }
    list.add_many(frame, facets);
    list.finish();
    if (!is_complete_) rays_.set_frame(frame);
    mask({&m, 1}, list);
  }
}

void CertifiedEstimator::divide_round(const SphereSource& source, std::span<uint32_t> members,
                                      const ReceiverHull& hull, int halvings) {
  const bool is_last = is_last_try(halvings);
  const RoundTarget target = target_of(source, hull);
  candidates_.facets.clear();
  candidates_.is_too_long = false;
  is_complete_ = false;
  if (!target.is_near) gather(hull, target.corners, target.normal, most_candidates(is_last));
  const bool wants_less = target.is_near || candidates_.is_too_long;
  if (wants_less && !is_last && members.size() >= 2) {
    const size_t half = halve_members(members);
    for (const std::span<uint32_t> side : {members.first(half), members.subspan(half)})
      divide_round(source, side, hull_of(side), halvings - 1);
    return;
  }
  if (candidates_.is_too_long) {
    found_->is_hopeless = true;
    shorten_candidates(hull.centre);
  }
  settle_round(source, members, hull);
}

std::span<const float> CertifiedEstimator::unoccluded(const SphereSource& source) {
  unoccluded_.resize(receivers_.size());
  for (size_t i = 0; i < receivers_.size(); ++i)
    unoccluded_[i] = float(sphere_irradiance(source.centre, source.radius, arrays_.position_at(i),
                                             arrays_.normal_at(i)));
  return unoccluded_;
}

void CertifiedEstimator::evaluate(const SphereSource& source, const SourceTerms& terms,
                                  ShadowScene& scene, FoundFacets& found,
                                  std::span<SourceVisibility> out) {
  source_ = nullptr;
  does_horizon_hide_ = has_own_horizons_;
  if (receivers_.empty()) return;
  unoccluded(source);
  if (!begin(terms, scene, found, out)) return;
  own_ = source.own;
  cell_unoccluded_ = unoccluded_;
  const bool is_all = members_.size() == receivers_.size();
  RaySource target;
  target.is_round = true;
  target.centre = source.centre;
  target.radius = source.radius;
  target.own = source.own;
  target.found = &found;
  target.brightness = terms.brightness;
  target.tag = terms.tag;
  rays_.set_source(target);
  divide_round(source, members_, is_all ? cluster_hull_ : hull_of(members_),
               options_.most_halvings);
  finish_sums();
}

}  // namespace troffer
