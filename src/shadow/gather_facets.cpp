#include "shadow/gather_facets.h"

#include <algorithm>
#include <cmath>

#include "shadow/direct_rays.h"
#include "shadow/pilot_rays.h"
#include "shadow/sphere_outline.h"

namespace troffer {

SourcePart& SourceParts::add() {
  if (count_ == parts_.size()) parts_.emplace_back();
  SourcePart& part = parts_[count_++];
  part.masked.clear();
  part.is_masked_known = false;
  return part;
}

namespace {

// Returns bounds of points that may be off by `pad`, widened for single precision.
Box padded_bounds(std::span<const Vec3d> points, double pad) {
  Boxd box;
  for (const Vec3d& p : points) box.grow(p);
  const Vec3d margin =
      Vec3d(pad) + max(max(box.upper, -box.upper), max(box.lower, -box.lower)) * 1.2e-7;
  return {Vec3(box.lower - margin), Vec3(box.upper + margin)};
}

// A shaft and the two bodies that it joins.
struct ShaftQuery {
  const ReceiverHull& hull;
  const Shaft& shaft;
  const Box& source;
  uint64_t own;
};

void gather(const ShaftQuery& s, size_t most, ShadowScene& scene, ShadowCandidates& out,
            CertifiedCounters& counters) {
  const Box receivers = padded_bounds({s.hull.corners.data(), size_t(s.hull.count)}, s.hull.slack);
  scene.candidates(s.shaft.all(), receivers, s.source, most, s.own, out);
  ++counters.gathers;
  counters.candidates += out.facets.size() + out.rounds.size();
  counters.incomplete += out.is_complete ? 0 : 1;
}

}  // namespace

void gather_facets(const ReceiverHull& hull, std::span<const Vec3d> outline, const Vec3d& normal,
                   size_t most, ShadowScene& scene, ShadowCandidates& out,
                   CertifiedCounters& counters) {
  const Shaft shaft = make_shaft(hull, outline, normal, scene.magnitude());
  gather({hull, shaft, padded_bounds(outline, 0), no_round_source}, most, scene, out, counters);
}

void gather_facets(const ReceiverHull& hull, const SphereSource& sphere, size_t most,
                   ShadowScene& scene, ShadowCandidates& out, CertifiedCounters& counters) {
  const Shaft shaft = make_shaft(hull, sphere.centre, sphere.radius, scene.magnitude());
  const Box ball = padded_bounds({&sphere.centre, 1}, sphere.radius);
  gather({hull, shaft, ball, sphere.own}, most, scene, out, counters);
}

namespace {

double diameter(std::span<const Vec3d> corners) {
  double most = 0;
  for (size_t i = 0; i < corners.size(); ++i)
    for (size_t j = 0; j < i; ++j) most = std::max(most, length_squared(corners[i] - corners[j]));
  return std::sqrt(most);
}

// Returns the approximate solid angle of the facet from a point.
float apparent_size(const Quad& q, const Vec3& x) {
  const Vec3 area = cross(q[2] - q[0], q[3] - q[1]) * 0.5f;
  const Vec3 d = (q[0] + q[2]) * 0.5f - x;
  const float square = dot(d, d) + 1e-12f;
  return std::abs(dot(area, d)) / (square * std::sqrt(square));
}

}  // namespace

void shorten_candidates(const FoundFacets& found, const Vec3d& centre, size_t most,
                        const ShadowScene& scene, std::vector<FacetToAdd>& facets) {
  std::vector<uint32_t> met;
  for (const FoundFacets::Entry& e : found.entries()) met.push_back(e.id);
  std::sort(met.begin(), met.end());
  const auto is_met = [&](uint32_t id) { return std::binary_search(met.begin(), met.end(), id); };
  std::vector<uint32_t> gathered;
  for (const FacetToAdd& f : facets)
    if (is_met(f.id)) gathered.push_back(f.id);
  std::sort(gathered.begin(), gathered.end());
  for (const uint32_t id : met)
    if (!std::binary_search(gathered.begin(), gathered.end(), id))
      facets.push_back({scene.facet(id), id, false});
  if (facets.size() <= most) return;
  const Vec3 x(centre);
  std::vector<std::pair<float, uint32_t>> order;
  for (uint32_t i = 0; i < facets.size(); ++i)
    order.emplace_back(is_met(facets[i].id) ? -1e30f : -apparent_size(facets[i].quad, x), i);
  std::nth_element(order.begin(), order.begin() + std::ptrdiff_t(most), order.end());
  std::vector<FacetToAdd> kept;
  for (size_t i = 0; i < most; ++i) kept.push_back(facets[order[i].second]);
  facets = std::move(kept);
}

namespace {

double half_diameter_of(const ReceiverHull& hull) {
  return 0.5 * diameter({hull.corners.data(), size_t(hull.count)});
}

// Fewest facets and round bodies before a sphere for which a cluster is halved.
constexpr size_t fewest_to_halve = 8;

// Relative costs (docs/log/certified-visibility.md, "Residual rays"): facets of a mask per direct
// ray; direct rays per mask, its certificates and its pilot samples; facets gathered per ray.
constexpr double facets_per_direct_ray = 6, rays_per_mask = 25, gathered_per_ray = 4;
// Facets that a mask may always have.
constexpr double fewest_facets = 384;

// State of the recursive division of one source.
struct Division {
  const SourceTask& task;
  ShadowScene& scene;
  GatherMemory& memory;
  CertifiedCounters& counters;

  bool is_last_try(int halvings, const ReceiverHull& hull) const {
    return halvings == 0 ||
           task.request.found->is_over_budget_at(hull.centre, half_diameter_of(hull));
  }
  // Returns the longest list. The last try keeps few facets, since its list stays incomplete.
  size_t most_facets(bool is_last) const {
    const CertifiedOptions& o = task.options;
    size_t most = o.longest_list;
    if (task.promise.error > 0) most = std::min(most, size_t(task.promise.longest_list));
    return is_last ? std::min(most, o.most_found) : most;
  }
  // Returns the longest list before a flat source. A list is worth gathering only while its masks
  // cost less than the rays that they replace.
  size_t most_before_flat(size_t members, bool is_last) const {
    const size_t longest = most_facets(is_last);
    if (is_last || !(task.promise.error > 0)) return longest;
    const FoundFacets::DirectRayPlan& dense = task.request.found->dense;
    const double worth =
        dense.is_known() ? facets_per_direct_ray * (dense.rays - rays_per_mask) : 0;
    const double shared = gathered_per_ray * double(members) * std::max(dense.rays, fewest_rays);
    return std::min(longest, size_t(std::min(std::max(worth, fewest_facets), shared)));
  }
  void cut_list(const ReceiverHull& hull) {
    task.request.found->note_over_budget(hull.centre, half_diameter_of(hull));
    shorten_candidates(*task.request.found, hull.centre, task.options.most_found, scene,
                       memory.candidates.facets);
    std::vector<RoundBody>& rounds = memory.candidates.rounds;
    rounds.resize(std::min(rounds.size(), task.options.most_found));
  }
  // Adds a part with the gathered list.
  SourcePart& add_part(std::span<const uint32_t> members, const ReceiverHull& hull) {
    SourcePart& part = memory.parts.add();
    part.members.assign(members.begin(), members.end());
    part.hull = hull;
    part.facets.swap(memory.candidates.facets);
    part.rounds.swap(memory.candidates.rounds);
    part.masked.swap(memory.candidates.masked);
    part.is_masked_known = memory.candidates.is_masked_known;
    part.is_complete = memory.candidates.is_complete;
    part.is_dark = false;
    part.is_over_budget = memory.candidates.is_too_long;
    return part;
  }

  // Adds a part whose occluders are unknown.
  void add_unknown(std::span<const uint32_t> members, const ReceiverHull& hull,
                   const FlatCell& cell, bool is_whole) {
    memory.candidates.facets.clear();
    memory.candidates.rounds.clear();
    memory.candidates.is_complete = false;
    memory.candidates.is_too_long = true;
    SourcePart& part = add_part(members, hull);
    part.cell = cell;
    part.is_whole = is_whole;
  }
  void flat(std::span<uint32_t> members, const ReceiverHull& hull, const FlatCell& cell,
            bool is_whole, int halvings);
  void halves(std::span<uint32_t> members, const ReceiverHull& hull, const FlatCell& cell,
              bool is_whole, int halvings);
  void sphere(std::span<uint32_t> members, const ReceiverHull& hull, int halvings);
};

// Gathers the facets of members and cell. If they are too many, halves the larger of the two
// bodies.
void Division::flat(std::span<uint32_t> members, const ReceiverHull& hull, const FlatCell& cell,
                    bool is_whole, int halvings) {
  const bool is_last = is_last_try(halvings, hull);
  FoundFacets& found = *task.request.found;
  // No single facet can hide the whole cell, so gathering is not worth its cost.
  if (is_last && halvings > 0 && found.dense.is_partly_open())
    return add_unknown(members, hull, cell, is_whole);
  const auto gather = [&](size_t most) {
    gather_facets(hull, cell.all_corners(), task.request.flat->plane.normal, most, scene,
                  memory.candidates, counters);
    return memory.candidates.is_too_long;
  };
  size_t most = most_before_flat(members.size(), is_last);
  bool is_too_long = gather(most);
  if (is_too_long && !is_last && task.promise.error > 0) {
    // The cost of rays decides how long lists may be.
    direct_rays_of(task, scene);
    const size_t worth = most_before_flat(members.size(), is_last);
    if (worth > most) is_too_long = gather(worth);
    if (is_too_long && found.dense.is_partly_open()) {
      found.note_over_budget(hull.centre, half_diameter_of(hull));
      return add_unknown(members, hull, cell, is_whole);
    }
  }
  if (is_last && is_too_long) cut_list(hull);
  if (!is_last && is_too_long) return halves(members, hull, cell, is_whole, halvings);
  SourcePart& part = add_part(members, hull);
  part.cell = cell;
  part.is_whole = is_whole;
}

void Division::halves(std::span<uint32_t> members, const ReceiverHull& hull, const FlatCell& cell,
                      bool is_whole, int halvings) {
  FlatCell first, second;
  const double hull_size = diameter({hull.corners.data(), size_t(hull.count)});
  const bool can_halve_members = members.size() >= 2 * task.options.smallest_cluster;
  if (can_halve_members && hull_size > 0.5 * diameter(cell.all_corners())) {
    const size_t half = halve_members(task.cluster, members);
    for (const std::span<uint32_t> side : {members.first(half), members.subspan(half)})
      flat(side, hull_of(task.cluster, side), cell, is_whole, halvings - 1);
  } else if (!cell.is_disk && halve(cell, first, second)) {
    flat(members, hull, first, false, halvings - 1);
    flat(members, hull, second, false, halvings - 1);
  } else {
    flat(members, hull, cell, is_whole, 0);
  }
}

void Division::sphere(std::span<uint32_t> members, const ReceiverHull& hull, int halvings) {
  const bool is_last = is_last_try(halvings, hull);
  const SphereSource& source = *task.request.sphere;
  const bool is_too_near = is_near(source, hull);
  ShadowCandidates& c = memory.candidates;
  if (is_too_near) {  // no shaft exists: rays decide
    c.facets.clear();
    c.rounds.clear();
    c.is_masked_known = false;
    c.is_too_long = c.is_complete = false;
  } else {
    gather_facets(hull, source, most_facets(is_last), scene, c, counters);
  }
  const bool is_long = (is_too_near || c.is_too_long) && !is_last && members.size() >= 2;
  // Each receiver rasterises the list on its own disk, which costs more than gathering twice.
  const bool is_worth_halving = !is_too_near && !c.is_too_long &&
                                c.facets.size() + c.rounds.size() >= fewest_to_halve &&
                                members.size() >= task.options.smallest_cluster;
  if (is_long || is_worth_halving) {
    const size_t half = halve_members(task.cluster, members);
    for (const std::span<uint32_t> side : {members.first(half), members.subspan(half)})
      sphere(side, hull_of(task.cluster, side), is_long ? halvings - 1 : halvings);
    return;
  }
  if (c.is_too_long) cut_list(hull);
  add_part(members, hull);
}

}  // namespace

void divide_flat(const SourceTask& task, std::span<uint32_t> members, const ReceiverHull& hull,
                 const FlatCell& cell, ShadowScene& scene, GatherMemory& memory,
                 CertifiedCounters& counters) {
  memory.parts.clear();
  Division division{task, scene, memory, counters};
  division.flat(members, hull, cell, true, task.options.most_halvings);
}

void divide_sphere(const SourceTask& task, std::span<uint32_t> members, const ReceiverHull& hull,
                   ShadowScene& scene, GatherMemory& memory, CertifiedCounters& counters) {
  memory.parts.clear();
  Division division{task, scene, memory, counters};
  division.sphere(members, hull, task.options.most_halvings);
}

bool has_rim(const FlatSource& source, double tolerance, size_t most, ShadowScene& scene) {
  const Vec3d n = source.plane.normal;
  const std::vector<Vec3d> corners = source.corners();
  Vec3d middle;
  for (const Vec3d& c : corners) middle = middle + c * (1.0 / double(corners.size()));
  const double margin = 2 * tolerance;
  std::vector<Plane> planes;
  const auto add = [&](const Vec3d& outwards, const Vec3d& point) {
    planes.push_back({Vec3(outwards), float(dot(outwards, point) + margin)});
  };
  add(n, source.plane.origin);
  add(-n, source.plane.origin);
  Box box;
  for (size_t i = 0; i < corners.size(); ++i) {
    const Vec3d& c = corners[i];
    box.grow(Vec3(c));
    const Vec3d side = cross(corners[(i + 1) % corners.size()] - c, n);
    const double size = length(side);
    if (size > 0) add(side * ((dot(side, c - middle) < 0 ? -1 : 1) / size), c);
  }
  ShadowCandidates near;
  scene.candidates(planes, box, box, most, no_round_source, near);
  bool is_rim = !near.is_complete || !near.rounds.empty();
  for (const FacetToAdd& f : near.facets)
    for (const Vec3& v : f.quad)
      is_rim = is_rim || dot(n, Vec3d(v) - source.plane.origin) > tolerance;
  return is_rim;
}

}  // namespace troffer
