#include "certified/shadow_world.h"

#include <algorithm>
#include <cmath>

namespace troffer {

namespace {

bool is_apart(const Box& a, const Box& b) {
  for (size_t axis = 0; axis < 3; ++axis)
    if (a.upper[axis] < b.lower[axis] || b.upper[axis] < a.lower[axis]) return true;
  return false;
}

}  // namespace

ShadowWorld::ShadowWorld(const Scene& scene, const Occluders& occluders, const Tracer& tracer)
    : occluders_(occluders), tracer_(tracer) {
  const Box box = bounds(scene);
  if (box.is_empty()) return;
  for (size_t a = 0; a < 3; ++a)
    magnitude_ =
        std::max({magnitude_, double(std::abs(box.lower[a])), double(std::abs(box.upper[a]))});
}

void ShadowWorld::candidates(std::span<const Plane> planes, const Box& receivers, const Box& source,
                             size_t most, uint64_t own, ShadowCandidates& out) {
  found_.facets.clear();
  found_.rounds.clear();
  found_.masked.clear();
  found_.others = 0;
  found_.own = own;
  found_.is_complete = true;
  found_.visited_nodes = 0;
  occluders_.gather(planes, most, found_);
  visited_nodes_ += found_.visited_nodes;
  out.facets.clear();
  out.rounds.assign(found_.rounds.begin(), found_.rounds.end());
  out.is_too_long = !found_.is_complete;
  out.is_complete = found_.is_complete && found_.others == 0;
  out.masked.assign(found_.masked.begin(), found_.masked.end());
  out.is_masked_known = found_.is_complete && found_.masked.size() == found_.others;
  for (const uint32_t id : found_.facets) {
    const Occluders::Component c = occluders_.component_of(id);
    const bool is_front_only =
        c.is_closed && is_apart(c.bounds, receivers) && is_apart(c.bounds, source);
    out.facets.push_back({occluders_.facet(id), id, is_front_only});
  }
}

void ShadowWorld::set_rays(std::span<const ShadowSegment> segments) {
  rays_.resize(segments.size());
  for (size_t i = 0; i < segments.size(); ++i) {
    rays_[i] = {};
    rays_[i].origin = segments[i].from;
    rays_[i].direction = segments[i].to - segments[i].from;
    rays_[i].t_min = segments[i].first;
    rays_[i].t_max = 1;
  }
}

void ShadowWorld::occluded(const SegmentArrays& segments, std::span<uint8_t> is_hidden) {
  const size_t n = segments.size();
  segments_.clear();
  segments_.make_room(n);
  for (size_t a = 0; a < 3; ++a) {
    std::copy_n(segments.from[a].data(), n, segments_.end(a));
    std::copy_n(segments.way[a].data(), n, segments_.end(a + 3));
  }
  segments_.grow(n);
  tracer_.occluded(segments_, is_hidden);
}

void ShadowWorld::trace(std::span<const ShadowSegment> segments, std::span<ShadowHit> hits) {
  set_rays(segments);
  hits_.resize(segments.size());
  tracer_.closest(rays_, hits_, Coherence::coherent, Meeting::no_panes);
  for (size_t i = 0; i < segments.size(); ++i) {
    hits[i] = {};
    const Hit& hit = hits_[i];
    if (!hit.is_valid() || Occluders::key(hit.geometry, hit.primitive) == segments[i].own) continue;
    const uint32_t id = occluders_.facet_of(hit.geometry, hit.primitive);
    hits[i] = {id == no_facet ? ray_hit_non_facet : id, hit.t};
  }
}

}  // namespace troffer
