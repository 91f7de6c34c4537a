#include "shadow/settle_part.h"

#include <algorithm>

#include "base/random.h"
#include "shadow/sphere_outline.h"

namespace troffer {

namespace {

// True if the lattice is mirrored, by the random numbers of a receiver.
bool is_mirrored(uint64_t stream, const SourceTask& task, uint32_t member) {
  return (mix64(stream + task.cluster.receivers[member].stream) & 1) != 0;
}

void set_list(const MaskFrame& frame, const SourcePart& part, std::span<const FacetToAdd> facets,
              FacetList& list) {
  list.clear();
  list.round().bodies = part.rounds;
  list.add_many(frame, facets);
  list.finish();
}

// Fills the list of occluders that only rays can decide. Returns null if there are none, or if they
// are not fully known.
const FacetList* set_masked(const MaskFrame& frame, const SourcePart& part, FacetList& list) {
  if (part.masked.empty() || !part.is_masked_known || part.is_over_budget) return nullptr;
  list.clear();
  for (const Quad& q : part.masked) list.add(frame, q);
  list.finish();
  return &list;
}

// Returns the unoccluded light of the whole source, or that of the cell, which is stored in
// `memory`.
std::span<const float> unoccluded_of(const SourceTask& task, const SourcePart& part,
                                     const FlatCell& cell, PartMemory& memory) {
  const bool is_all = memory.cells.size() == 1 && (part.is_whole || cell.is_disk);
  if (is_all) return task.unoccluded;
  unoccluded_light(task.cluster, *task.request.flat, cell.all_corners(), memory.unoccluded);
  return memory.unoccluded;
}

void settle_by_masks(const SourceTask& task, const SourcePart& part, uint64_t& stream,
                     PartMemory& memory, SourceResults& results) {
  plan_cells(task, part, hash_of(stream, task.request.stream, part.members[0]), memory.pilots,
             memory.settle, memory.cells);
  memory.receivers.set(task.cluster, part.members, part.hull);
  for (const auto& [cell, lattice, facets] : memory.cells) {
    ++results.counters.cells;
    stream = hash_of(stream, 1u);
    const std::span<const float> unoccluded = unoccluded_of(task, part, cell, memory);
    memory.members.clear();
    for (const uint32_t m : part.members)
      if (unoccluded[m] > 0) memory.members.push_back(m);
    if (memory.members.empty()) continue;
    const MaskFrame frame(cell.plane, lattice,
                          is_mirrored(stream + task.request.stream, task, part.members[0]),
                          part.hull.centre, cell.all_outline(), cell.is_disk);
    if (!part.is_complete) results.rays.frames.push_back(frame);
    set_list(frame, part, facets, memory.settle.lists[0]);
    const bool is_all = memory.members.size() == part.members.size();
    if (!is_all)
      memory.some_receivers.set(task.cluster, memory.members,
                                hull_of(task.cluster, memory.members));
    settle_cell({task, frame, unoccluded, stream, part.is_complete, part.is_over_budget,
                 set_masked(frame, part, memory.masked)},
                is_all ? memory.receivers : memory.some_receivers, memory.settle, results);
  }
}

// True if one facet hides all of the part from all of its members.
bool is_dark(const SourceTask& task, const SourcePart& part, SettleMemory& memory) {
  const MaskFrame frame(part.cell.plane, coarse_lattice, false, part.hull.centre,
                        part.cell.all_outline(), part.cell.is_disk);
  set_list(frame, part, part.facets, memory.lists[0]);
  return certify({task, frame, task.unoccluded, 0, false, true}, part.hull, memory.lists[0],
                 memory.flags, memory.lists[1]) == Certificate::dark;
}

// Answers a part that is dark, or leaves it to the caller, without masks or rays.
void answer_without_masks(const SourceTask& task, const SourcePart& part, PartMemory& memory,
                          SourceResults& results) {
  memory.cells.assign(1, {part.cell, coarse_lattice, {}});
  const std::span<const float> unoccluded = unoccluded_of(task, part, part.cell, memory);
  for (const uint32_t m : part.members)
    if (unoccluded[m] > 0)
      results.sums[m].add(unoccluded[m], 0, 0,
                          part.is_dark ? ShadowAnswer::dark : ShadowAnswer::mixed);
  if (!part.is_dark)
    results.left->push_back({task.number, part.cell, {unoccluded.begin(), unoccluded.end()}});
}

}  // namespace

void settle_flat_part(const SourceTask& task, const SourcePart& part, uint64_t& stream,
                      ShadowScene& scene, PartMemory& memory, SourceResults& results) {
  if (part.is_dark ||
      (part.is_over_budget && task.request.far != nullptr && results.left != nullptr))
    return answer_without_masks(task, part, memory, results);
  if (!part.is_over_budget || is_dark(task, part, memory.settle))
    return settle_by_masks(task, part, stream, memory, results);
  // Receivers with an integrand need masks, because it is evaluated at open points.
  SourcePart others = part;
  const auto with_values =
      std::stable_partition(others.members.begin(), others.members.end(),
                            [&](uint32_t m) { return task.wanted_points[m] == 0; });
  const std::vector<uint32_t> members(others.members.begin(), with_values);
  others.members.erase(others.members.begin(), with_values);
  cast_direct_rays(task, part, members, scene, memory.rays, results);
  if (!others.members.empty()) settle_by_masks(task, others, stream, memory, results);
}

namespace {

// Moves the facets that reach into the sphere out of the part and returns them. Removes what lies
// within the sphere, since it hides nothing.
std::vector<Quad> take_entering(const SphereSource& sphere, SourcePart& part) {
  std::vector<Quad> entering;
  for (const FacetToAdd& f : part.facets)
    if (may_enter(f.quad, sphere) && !is_within(f.quad, sphere)) entering.push_back(f.quad);
  std::erase_if(part.facets, [&](const FacetToAdd& f) { return may_enter(f.quad, sphere); });
  std::erase_if(part.rounds, [&](const RoundBody& b) { return is_within(b, sphere); });
  for (const Quad& q : part.masked)
    part.is_masked_known = part.is_masked_known && !may_enter(q, sphere);
  return entering;
}

}  // namespace

void settle_sphere_part(const SourceTask& task, SourcePart& part, PartMemory& memory,
                        SourceResults& results) {
  const SphereSource& sphere = *task.request.sphere;
  const std::vector<Quad> entering = take_entering(sphere, part);
  ++results.counters.cells;
  const uint64_t stream = task.request.stream;
  for (const uint32_t m : part.members) {
    const MaskFrame frame(outline_of(sphere, Vec3d(task.cluster.receivers[m].position)),
                          task.options.lattice, is_mirrored(stream, task, m), part.hull.centre, {},
                          true);
    const SourceCellTask disk{task,
                              frame,
                              task.unoccluded,
                              stream,
                              part.is_complete,
                              part.is_over_budget,
                              set_masked(frame, part, memory.masked)};
    const bool is_nothing = part.facets.empty() && part.rounds.empty() && entering.empty();
    if (part.is_complete && is_nothing && !task.does_horizon_hide()) {
      add_lit(disk, m, memory.settle.masks, results);
      continue;
    }
    FacetList& list = memory.settle.lists[0];
    set_list(frame, part, part.facets, list);
    list.round().is_source_round = true;
    list.round().source = {sphere.centre, sphere.radius};
    list.round().entering = entering;
    if (!part.is_complete) results.rays.frames.push_back(frame);
    mask_cell(disk, {&m, 1}, list, memory.settle.masks, results);
  }
}

}  // namespace troffer
