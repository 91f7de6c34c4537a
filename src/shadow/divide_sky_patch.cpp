#include "shadow/divide_sky_patch.h"

#include <algorithm>
#include <cmath>

#include "shadow/pilot_rays.h"
#include "shadow/settle_cell.h"

namespace troffer {

namespace {

// Limit of nested halvings of a cell: 4 × 4 parts of a whole face of the cube.
constexpr int most_halvings = 4;
// Costs in facets of a mask: of gathering a list, of each facet found, of testing a large facet,
// and of a mask.
constexpr double cost_of_gather = 1000, cost_of_found = 10, cost_of_large = 5,
                 cost_of_far_mask = 60;
// Share of that cost which proofs may lose: least_lost if most of the light arrives, up to all of
// it if little does, since rays err by more there.
constexpr double least_lost = 0.05, lost_by_open = 2.5;
// Masks may cost this many times as much as rays, because they err by less.
constexpr double worth_of_mask = 2;
constexpr size_t always_masked = 16;  // facets; shorter lists are always masked
// Cost per facet of a list: masks, pilot samples and halvings of clusters. The limits keep lists
// long enough for blinds and plants in front of a window.
constexpr double cost_of_list = 120, most_facets = 4096, fewest_far_facets = 64, usual_members = 32;

class SkyPatchDivision {
 public:
  SkyPatchDivision(const SourceTask& task, std::span<const uint32_t> members,
                   const ReceiverHull& hull, ShadowScene& scene, GatherMemory& memory,
                   CertifiedCounters& counters)
      : task_(task),
        members_(members),
        hull_(hull),
        scene_(scene),
        memory_(memory),
        counters_(counters),
        allowed_(allowed_work()),
        work_(allowed_),
        most_(longest_list()) {}

  // Divides a cell. share: its share of the whole cell.
  void divide(const FlatCell& cell, bool is_whole, int halvings, double share = 1) {
    if (!is_whole && !is_worth_more()) return add_over_budget(cell, is_whole);
    gather_facets(hull_, cell.all_corners(), task_.request.flat->plane.normal, most_, scene_,
                  memory_.candidates, counters_);
    const std::span<const FacetToAdd> frame = task_.request.frame;
    memory_.candidates.facets.insert(memory_.candidates.facets.end(), frame.begin(), frame.end());
    work_ -= cost_of_gather + cost_of_found * double(length_of_list());
    FlatCell first, second;
    const size_t length = length_of_list();
    const double masks = double(members_.size()) * (cost_of_far_mask + double(length));
    if (!memory_.candidates.is_too_long && length > always_masked &&
        masks > worth_of_mask * share * allowed_) {
      add_over_budget(cell, is_whole);  // rays are cheaper
    } else if (!memory_.candidates.is_too_long) {
      work_ -= length > 0 ? masks : 0;
      won_ += share * allowed_;
      add_part(cell, is_whole);
    } else if (is_dark(cell)) {
      clear_list();
      memory_.candidates.is_complete = true;
      memory_.candidates.is_too_long = false;
      won_ += share * allowed_;
      add_part(cell, is_whole).is_dark = true;
    } else if (halvings == 0 || !is_worth_more() || cell.is_disk || !halve(cell, first, second)) {
      add_over_budget(cell, is_whole);
    } else {
      divide(first, false, halvings - 1, share / 2);
      divide(second, false, halvings - 1, share / 2);
    }
  }

  // Gives up the whole cell without looking at its facets.
  void leave(const FlatCell& cell) { add_over_budget(cell, true); }
  double work() const { return work_; }

 private:
  double most_lost() const {
    return std::max(least_lost, 1 - lost_by_open * task_.promise.far_open);
  }
  // True while the net cost of proofs is a small part of what rays would cost.
  bool is_worth_more() const {
    return work_ > 0 && allowed_ - work_ <= most_lost() * allowed_ + won_;
  }
  size_t length_of_list() const {
    return memory_.candidates.facets.size() + memory_.candidates.rounds.size();
  }
  void clear_list() {
    memory_.candidates.facets.clear();
    memory_.candidates.rounds.clear();
  }

  // Returns the cost of rays to this cell, by its share of the unoccluded light of all sources.
  double allowed_work() const {
    const MaskBudget& p = task_.promise;
    if (!(p.error > 0)) return 1e30;
    double own = 0, all = 0;
    for (const uint32_t m : members_) {
      const double light = double(task_.unoccluded[m]);
      own += light;
      all += std::max(double(p.seen[m]) + light + double(p.rest[m]), light);
    }
    const double rays = rays_for_error(p.far_open, double(p.error));
    return double(members_.size()) * facets_per_ray * rays * (all > 0 ? own / all : 0);
  }
  size_t longest_list() const {
    const double fewest =
        fewest_far_facets * std::min(1.0, double(members_.size()) / usual_members);
    const double wanted = std::clamp(work_ / cost_of_list, fewest, most_facets);
    return std::min(task_.options.longest_list, size_t(wanted));
  }

  bool is_dark(const FlatCell& cell) {
    const std::span<const FacetToAdd> large = task_.request.far->large;
    if (large.empty() && task_.request.frame.empty()) return false;
    work_ -= cost_of_large * double(large.size());
    const MaskFrame frame(cell.plane, coarse_lattice, false, hull_.centre, cell.all_outline(),
                          cell.is_disk);
    FacetList& list = memory_.large;
    list.clear();
    list.add_many(frame, large);
    list.add_many(frame, task_.request.frame);
    list.finish();
    return certify({task_, frame, task_.unoccluded, 0, false, true}, hull_, list, memory_.flags,
                   memory_.left) == Certificate::dark;
  }

  void add_over_budget(const FlatCell& cell, bool is_whole) {
    clear_list();
    memory_.candidates.is_too_long = true;
    memory_.candidates.is_complete = false;
    add_part(cell, is_whole);
  }

  SourcePart& add_part(const FlatCell& cell, bool is_whole) {
    SourcePart& part = memory_.parts.add();
    part.members.assign(members_.begin(), members_.end());
    part.hull = hull_;
    part.cell = cell;
    part.is_whole = is_whole;
    part.is_dark = false;
    part.facets.swap(memory_.candidates.facets);
    part.rounds.swap(memory_.candidates.rounds);
    part.is_complete = memory_.candidates.is_complete;
    part.is_over_budget = memory_.candidates.is_too_long;
    return part;
  }

  const SourceTask& task_;
  std::span<const uint32_t> members_;
  const ReceiverHull& hull_;
  ShadowScene& scene_;
  GatherMemory& memory_;
  CertifiedCounters& counters_;
  double allowed_;  // cost of rays to the whole cell, in facets of a mask
  double work_;     // part of allowed_ that is not used yet
  double won_ = 0;  // cost of rays saved by settled parts
  size_t most_;     // facets per list
};

}  // namespace

void divide_sky_patch(const SourceTask& task, std::span<const uint32_t> members,
                      const ReceiverHull& hull, const FlatCell& cell, ShadowScene& scene,
                      GatherMemory& memory, CertifiedCounters& counters) {
  memory.parts.clear();
  FoundFacets& found = *task.request.found;
  const double radius = hull.radius();
  // A cell close to one that was over budget is not halved again. A cluster of few receivers is not
  // even tried.
  const bool is_over_budget = found.is_over_budget_at(hull.centre, radius);
  SkyPatchDivision division(task, members, hull, scene, memory, counters);
  if (division.work() < cost_of_gather)
    division.leave(cell);
  else
    division.divide(cell, true, is_over_budget ? 0 : most_halvings);
  size_t over_budget = 0;
  for (const SourcePart& p : memory.parts.all()) over_budget += p.is_over_budget ? 1 : 0;
  if (!is_over_budget && 4 * over_budget >= 3 * memory.parts.all().size() && over_budget > 0)
    found.note_over_budget(hull.centre, radius);
}

}  // namespace troffer
