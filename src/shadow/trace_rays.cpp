#include "shadow/trace_rays.h"

namespace troffer {

// Occluders in the source's plane hide nothing: the source itself, and the surface around it.
// Shafts and masks use the same height.
bool is_free(const RaySource& source, const ShadowSegment& segment, const ShadowHit& hit,
             const ShadowScene& scene) {
  if (hit.id == ray_is_free) return true;
  if (source.is_round) return false;
  const auto height = [&](const Vec3& p) { return dot(source.normal, Vec3d(p) - source.point); };
  if (hit.id == ray_hit_non_facet)
    return height(segment.from) * double(1 - hit.t) <= source.tolerance;
  for (const Vec3& v : scene.facet(hit.id))
    if (height(v) > source.tolerance) return false;
  return true;
}

namespace {

// Traces rays of over-budget sources to just before the source, with the cheap test for any
// occluder: their facets need no ids. Free rays are traced to the end only if a rim exists.
void trace_any_hit(std::span<const RaySource> sources, RayPlan& plan, ShadowScene& scene,
                   TracedRays& t) {
  t.before.clear();
  t.has_rim.clear();
  t.picked.clear();
  t.picked_arrays.resize(0);
  for (const RayGroup& g : plan.groups) {
    const RaySource& s = sources[g.source];
    if (!s.found->is_over_budget() || s.is_round) continue;
    for (uint32_t i = g.first; i < g.first + g.count; ++i) {
      const double height = dot(s.normal, Vec3d(plan.segments[i].from) - s.point);
      const double end = 1 - 1.25 * s.tolerance / height;
      if (!(end > 0)) continue;
      t.picked.push_back(i);
      t.picked_arrays.add(plan.segments[i], float(end));
      t.before.push_back(float(end));
      t.has_rim.push_back(s.found->rim == FoundFacets::Rim::none ? 0 : 1);
    }
  }
  t.is_hidden.resize(t.picked.size());
  scene.occluded(t.picked_arrays, t.is_hidden);
  for (size_t k = 0; k < t.picked.size(); ++k) {
    const uint32_t i = t.picked[k];
    plan.segments[i].first = t.before[k];
    if (t.is_hidden[k] != 0)
      t.states[i] = RayState::hidden;
    else if (t.has_rim[k] == 0)
      t.states[i] = RayState::free;
  }
}

// Sets the hits of rays that are still open.
void trace_open(const RayPlan& plan, ShadowScene& scene, TracedRays& t) {
  t.picked.clear();
  t.picked_segments.clear();
  for (uint32_t i = 0; i < plan.segments.size(); ++i) {
    if (t.states[i] != RayState::open) continue;
    t.picked.push_back(i);
    t.picked_segments.push_back(plan.segments[i]);
  }
  t.picked_hits.resize(t.picked.size());
  scene.trace(t.picked_segments, t.picked_hits);
  for (size_t k = 0; k < t.picked.size(); ++k) t.hits[t.picked[k]] = t.picked_hits[k];
}

// Decides which rays are free, and notes the facets that others hit.
void look_at_hits(std::span<const RaySource> sources, const RayPlan& plan, const ShadowScene& scene,
                  TracedRays& t) {
  t.is_free.resize(plan.segments.size());
  t.tallies.assign(sources.size(), {});
  std::vector<std::vector<uint32_t>> found(sources.size());
  for (const RayGroup& g : plan.groups) {
    const RaySource& source = sources[g.source];
    RayTally& tally = t.tallies[g.source];
    for (uint32_t i = g.first; i < g.first + g.count; ++i) {
      const bool is_open = t.states[i] == RayState::open;
      t.is_free[i] = is_open ? is_free(source, plan.segments[i], t.hits[i], scene)
                             : t.states[i] == RayState::free;
      tally.rays += 1;
      tally.free += t.is_free[i];
      if (is_open && t.is_free[i] == 0 && t.hits[i].id != ray_hit_non_facet)
        found[g.source].push_back(t.hits[i].id);
    }
  }
  for (size_t s = 0; s < sources.size(); ++s)
    if (!found[s].empty()) sources[s].found->add(found[s]);
}

}  // namespace

void trace_rays(std::span<const RaySource> sources, RayPlan& plan, ShadowScene& scene,
                TracedRays& out) {
  out.states.assign(plan.segments.size(), RayState::open);
  out.hits.assign(plan.segments.size(), ShadowHit{});
  trace_any_hit(sources, plan, scene, out);
  trace_open(plan, scene, out);
  look_at_hits(sources, plan, scene, out);
}

}  // namespace troffer
