#include "shadow/residual_rays.h"

#include <algorithm>
#include <cmath>

#include "base/random.h"

namespace troffer {

namespace {

// So many rays of one receiver are worth an order in which packets are compact.
constexpr uint32_t fewest_compact = 96;

}  // namespace

void FoundFacets::add(std::vector<uint32_t>& ids) {
  std::sort(ids.begin(), ids.end());
  const size_t before = entries_.size();
  for (size_t i = 0; i < ids.size();) {
    size_t end = i;
    while (end < ids.size() && ids[end] == ids[i]) ++end;
    const auto hits = uint32_t(end - i);
    const auto known = std::find_if(entries_.begin(), entries_.begin() + std::ptrdiff_t(before),
                                    [&](const Entry& e) { return e.id == ids[i]; });
    if (known != entries_.begin() + std::ptrdiff_t(before))
      known->hits += hits;
    else
      entries_.push_back({ids[i], hits});
    i = end;
  }
}

void FoundFacets::trim(size_t most) {
  std::stable_sort(entries_.begin(), entries_.end(),
                   [](const Entry& a, const Entry& b) { return a.hits > b.hits; });
  if (entries_.size() > most) entries_.resize(most);
  for (Entry& e : entries_) e.hits = (e.hits + 1) / 2;
}

void ResidualRays::begin(size_t receivers) {
  receivers_ = receivers;
  sources_.clear();
  frames_.clear();
  pending_.clear();
  chosen_.clear();
  chosen_points_.clear();
  chosen_origins_.clear();
  chosen_values_.clear();
  segments_.clear();
  groups_.clear();
  answers_.clear();
}

void ResidualRays::set_source(const RaySource& source) {
  sources_.push_back(source);
}

void ResidualRays::set_frame(const MaskFrame& frame) {
  frames_.push_back(frame);
}

void ResidualRays::add(uint32_t member, const Vec3& origin, const OpenSamples& samples, float light,
                       float unoccluded, uint64_t random, uint32_t passes) {
  pending_.push_back({member, uint32_t(sources_.size() - 1), uint32_t(frames_.size() - 1), origin,
                      light, unoccluded, random, passes, samples});
}

void ResidualRays::add(uint32_t member, const Vec3& origin, std::span<const Vec3> points,
                       std::span<const Rgb> values, float light) {
  chosen_.push_back({member, uint32_t(sources_.size() - 1), uint32_t(chosen_points_.size()),
                     uint32_t(points.size()), light});
  chosen_origins_.push_back(origin);
  chosen_points_.insert(chosen_points_.end(), points.begin(), points.end());
  chosen_values_.insert(chosen_values_.end(), values.begin(), values.end());
}

void ResidualRays::scale(size_t first, std::span<const float> factor) {
  for (size_t i = first; i < pending_.size(); ++i) pending_[i].light *= factor[pending_[i].member];
}

namespace {

// From x towards p: where the segment first meets the sphere; p itself where it does not.
Vec3 near_end(const RaySource& s, const Vec3& x, const Vec3& p) {
  const Vec3d d = normalize(Vec3d(p) - Vec3d(x)), to_centre = s.centre - Vec3d(x);
  const double along = dot(to_centre, d);
  const double half2 = s.radius * s.radius - length_squared(to_centre - d * along);
  return Vec3(Vec3d(x) + d * (along - std::sqrt(std::max(half2, 0.0))));
}

}  // namespace

void ResidualRays::add_segments(const Vec3& origin, const RaySource& source,
                                std::span<const Vec3> points) {
  for (const Vec3& p : points)
    segments_.push_back({origin, source.is_round ? near_end(source, origin, p) : p, source.own});
}

namespace {

// Rays for a pair's own visible share.
float rays_for_share(float light, float unoccluded, const RayLimits& limits) {
  return std::min(sqr(0.5f * light / unoccluded / limits.pair_error), float(limits.most_pair_rays));
}

}  // namespace

void ResidualRays::cast_pending(std::span<const float> allowed, const RayLimits& limits) {
  open_.assign(receivers_, 0);
  for_shares_.assign(receivers_, 0);
  for (const Pending& p : pending_) {
    open_[p.member] += sources_[p.source].brightness * p.light;
    for_shares_[p.member] += rays_for_share(p.light, p.unoccluded, limits);
  }
  for (const Pending& p : pending_) {
    const float open = sources_[p.source].brightness * p.light;
    // Rays of the receiver altogether, were numbers not whole. Quotients before squares: those of
    // brightness may overflow, and a source may have none.
    const float error = allowed[p.member];
    const float all = error > 0 ? sqr(open_[p.member] / (2 * error)) : float(limits.most_rays);
    const float share = open > 0 ? open / open_[p.member] : 0;
    const float wanted = share * std::min(all, float(limits.most_rays));
    // One of hundreds of sources is not worth as many rays as one of a few.
    const float scale = std::min(float(limits.most_share_rays) / for_shares_[p.member], 1.0f);
    const float for_share = rays_for_share(p.light, p.unoccluded, limits) * scale;
    const auto n = uint32_t(std::max(std::ceil(std::max(wanted, for_share) - 1e-3f), 1.0f));
    points_.clear();
    (n < fewest_compact ? draw_points : draw_points_compact)(frames_[p.frame], p.samples, n,
                                                             p.random, points_);
    groups_.push_back({p.source, uint32_t(segments_.size()), uint32_t(points_.size()),
                       uint32_t(answers_.size()), p.frame, p.passes, false, p.light});
    answers_.push_back({p.member, sources_[p.source].tag, uint32_t(points_.size()), 0, 0, {}, 0});
    add_segments(p.origin, sources_[p.source], points_);
  }
}

void ResidualRays::cast_chosen() {
  for (size_t i = 0; i < chosen_.size(); ++i) {
    const Chosen& c = chosen_[i];
    groups_.push_back({c.source, uint32_t(segments_.size()), c.count, uint32_t(answers_.size()), 0,
                       1, true, c.light});
    answers_.push_back({c.member, sources_[c.source].tag, c.count, 0, 0, {}, 0});
    add_segments(chosen_origins_[i], sources_[c.source],
                 std::span(chosen_points_).subspan(c.first, c.count));
  }
}

// What lies in the source's plane hides nothing of it: the source itself, and what it is set into.
// The shaft and the masks draw the line at the same height.
bool ResidualRays::is_free(const RaySource& source, const ShadowSegment& segment,
                           const ShadowHit& hit, const ShadowScene& scene) const {
  if (hit.id == ray_is_free) return true;
  if (source.is_round) return false;
  const auto height = [&](const Vec3& p) { return dot(source.normal, Vec3d(p) - source.point); };
  if (hit.id == ray_is_stopped) return height(segment.from) * double(1 - hit.t) <= source.tolerance;
  for (const Vec3& v : scene.facet(hit.id))
    if (height(v) > source.tolerance) return false;
  return true;
}

// What all rays of a cluster to one source say of a single one.
struct ResidualRays::Tally {
  double rays = 0, free = 0;

  // p (1 - p) is concave: the share of all rays bounds, on average, what the shares of the single
  // groups would give.
  double spread() const {
    const double p = (free + 1) / (rays + 2);
    return p * (1 - p);
  }
};
// Variance that a change from one ray to the next stands for, in squares of what a ray stands for.
// Two neighbouring strata that are open with probabilities p and q differ with probability
// p (1 - q) + q (1 - p), which is p (1 - p) + q (1 - q) + (p - q)²: half the number of changes is,
// on average, no less than the variance, but for half of that of the first and the last one.
constexpr float variance_of_change = 0.5f;

// Any occluder will do where nobody wants to know which one it was: rays that end just before the
// source. Those that are free go the rest of the way if there is anything in it.
void ResidualRays::trace_without_names(ShadowScene& scene) {
  before_.clear();
  has_rim_.clear();
  picked_.clear();
  picked_segments_.clear();
  for (const Group& g : groups_) {
    const RaySource& s = sources_[g.source];
    if (!s.found->is_hopeless || s.is_round) continue;
    for (uint32_t i = g.first; i < g.first + g.count; ++i) {
      const double height = dot(s.normal, Vec3d(segments_[i].from) - s.point);
      const double end = 1 - 1.25 * s.tolerance / height;
      if (!(end > 0)) continue;
      picked_.push_back(i);
      picked_segments_.push_back(segments_[i]);
      before_.push_back(float(end));
      has_rim_.push_back(s.found->rim == FoundFacets::Rim::none ? 0 : 1);
    }
  }
  is_hidden_.resize(picked_.size());
  scene.occluded(picked_segments_, before_, is_hidden_);
  for (size_t k = 0; k < picked_.size(); ++k) {
    const uint32_t i = picked_[k];
    segments_[i].first = before_[k];
    if (is_hidden_[k] != 0)
      state_[i] = RayState::hidden;
    else if (has_rim_[k] == 0)
      state_[i] = RayState::free;
  }
}

void ResidualRays::trace(ShadowScene& scene) {
  state_.assign(segments_.size(), RayState::open);
  hits_.assign(segments_.size(), ShadowHit{});
  trace_without_names(scene);
  picked_.clear();
  picked_segments_.clear();
  for (uint32_t i = 0; i < segments_.size(); ++i) {
    if (state_[i] != RayState::open) continue;
    picked_.push_back(i);
    picked_segments_.push_back(segments_[i]);
  }
  picked_hits_.resize(picked_.size());
  scene.trace(picked_segments_, picked_hits_);
  for (size_t k = 0; k < picked_.size(); ++k) hits_[picked_[k]] = picked_hits_[k];
}

std::vector<ResidualRays::Tally> ResidualRays::look_at_hits(const ShadowScene& scene) {
  is_free_.resize(segments_.size());
  std::vector<Tally> tallies(sources_.size());
  std::vector<std::vector<uint32_t>> found(sources_.size());
  for (const Group& g : groups_) {
    const RaySource& source = sources_[g.source];
    Tally& t = tallies[g.source];
    for (uint32_t i = g.first; i < g.first + g.count; ++i) {
      const bool is_open = state_[i] == RayState::open;
      is_free_[i] =
          is_open ? is_free(source, segments_[i], hits_[i], scene) : state_[i] == RayState::free;
      t.rays += 1;
      t.free += is_free_[i];
      if (is_open && is_free_[i] == 0 && hits_[i].id != ray_is_stopped)
        found[g.source].push_back(hits_[i].id);
    }
  }
  for (size_t s = 0; s < sources_.size(); ++s)
    if (!found[s].empty()) sources_[s].found->add(found[s]);
  return tallies;
}

void ResidualRays::add_light(const Group& g, const Tally& tally) {
  RayAnswer& a = answers_[g.answer];
  uint32_t free = 0, changes = 0;
  for (uint32_t i = g.first; i < g.first + g.count; ++i) {
    free += is_free_[i];
    changes += i > g.first && is_free_[i] != is_free_[i - 1];
  }
  const float ray = g.light / float(g.count);
  a.light = ray * float(free);
  a.light_variance = sqr(ray) * (float(tally.spread()) + float(changes) * variance_of_change);
}

void ResidualRays::add_value(const Group& g, size_t first_value) {
  RayAnswer& a = answers_[g.answer];
  const auto n = float(g.count);
  Rgb sum;
  float squares = 0;
  for (uint32_t i = 0; i < g.count; ++i) {
    if (is_free_[g.first + i] == 0) continue;
    const Rgb& value = chosen_values_[first_value + i];
    sum += value;
    squares += sqr(luminance(value));
  }
  a.value = sum * (g.light / n);
  const float spread = std::max(squares - sqr(luminance(sum)) / n, 0.0f);
  a.value_variance = sqr(g.light) * spread / (n * std::max(n - 1, 1.0f));
}

// Several masks of a pair, by different shifts, each with rays of its own, are as many independent
// estimates: their spread tells what masks and rays err by together. Where the first of them stands
// at first_group.
void ResidualRays::tell_passes(size_t first_group) {
  const Group& first = groups_[first_group];
  const uint32_t member = answers_[first.answer].member;
  size_t end = first_group;
  float sum = 0, squares = 0;
  for (; end < groups_.size() && groups_[end].frame == first.frame &&
         groups_[end].passes == first.passes && !groups_[end].has_values &&
         answers_[groups_[end].answer].member == member;
       ++end) {
    RayAnswer& a = answers_[groups_[end].answer];
    sum += a.light;
    squares += sqr(a.light);
    a.light_variance = 0;
  }
  const auto n = float(first.passes);
  answers_[first.answer].light_variance =
      std::max(squares - sqr(sum) / n, 0.0f) * n / std::max(n - 1, 1.0f);
}

void ResidualRays::add_up(const ShadowScene& scene) {
  const std::vector<Tally> tallies = look_at_hits(scene);
  size_t next_value = 0;
  for (const Group& g : groups_) {
    if (g.count == 0) continue;
    if (g.has_values) {
      add_value(g, next_value);
      next_value += g.count;
    } else {
      add_light(g, tallies[g.source]);
    }
  }
  for (size_t i = 0; i < groups_.size(); ++i) {
    const Group& g = groups_[i];
    const bool is_first = i == 0 || groups_[i - 1].frame != g.frame || groups_[i - 1].has_values ||
                          answers_[groups_[i - 1].answer].member != answers_[g.answer].member;
    if (g.passes > 1 && is_first) tell_passes(i);
  }
}

std::span<const RayAnswer> ResidualRays::finish(ShadowScene& scene, std::span<const float> allowed,
                                                const RayLimits& limits, size_t most_found) {
  if (is_empty()) return {};
  cast_pending(allowed, limits);
  cast_chosen();
  trace(scene);
  add_up(scene);
  for (const RaySource& s : sources_) s.found->trim(most_found);
  return answers_;
}

}  // namespace troffer
