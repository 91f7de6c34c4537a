#include "shadow/divide_far.h"

#include <algorithm>
#include <cmath>

#include "shadow/pilot_rays.h"
#include "shadow/settle_cell.h"

namespace troffer {

namespace {

// A cell is halved so often at most: a face of the cube comes to 4 × 4 parts.
constexpr int most_halvings = 4;
// What the cluster's rays to all lights would cost, in facets of a mask, is what a proof may cost:
// a few times that, by the share of the light. A gather costs about so many facets, and so many for
// each that it finds; a large facet is tried once.
constexpr double facets_per_far_ray = 12;
constexpr double cost_of_gather = 1000, cost_of_found = 10, cost_of_large = 5,
                 cost_of_far_mask = 60;
// … of which proofs may lose this share where most of the light arrives; where little does they may
// lose all: rays err by more there than they should.
constexpr double least_lost = 0.05, lost_by_open = 2.5;
// … and masks, which err by much less than they may, may cost so many times as much.
constexpr double worth_of_mask = 2;
constexpr size_t always_masked = 16;  // facets
// A list costs masks, pilots and halvings of clusters: so many times its length. But blinds and
// plants before a window are to be masked.
constexpr double cost_of_list = 120, most_facets = 4096, fewest_far_facets = 64, usual_members = 32;

class FarDivision {
 public:
  FarDivision(const SourceTask& task, std::span<const uint32_t> members, const ReceiverHull& hull,
              ShadowScene& scene, GatherMemory& memory, CertifiedCounters& counters)
      : task_(task),
        members_(members),
        hull_(hull),
        scene_(scene),
        memory_(memory),
        counters_(counters),
        allowed_(allowed_work()),
        work_(allowed_),
        most_(longest_list()) {}

  // share: of the whole cell.
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

  // Without a look at anything.
  void leave(const FlatCell& cell) { add_over_budget(cell, true); }
  double work() const { return work_; }

 private:
  double most_lost() const {
    return std::max(least_lost, 1 - lost_by_open * task_.promise.far_open);
  }
  // What proofs cost beyond what they have won is to be a small part of what rays would.
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

  // By the share of the light that all sources would send.
  double allowed_work() const {
    const Promise& p = task_.promise;
    if (!(p.error > 0)) return 1e30;
    double own = 0, all = 0;
    for (const uint32_t m : members_) {
      const double light = double(task_.unoccluded[m]);
      own += light;
      all += std::max(double(p.seen[m]) + light + double(p.rest[m]), light);
    }
    const double rays = rays_for_error(p.far_open, double(p.error));
    return double(members_.size()) * facets_per_far_ray * rays * (all > 0 ? own / all : 0);
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
  double allowed_;  // what rays to the whole cell would cost, in facets of a mask
  double work_;     // of that is left
  double won_ = 0;  // by parts that need no rays
  size_t most_;     // facets in a list
};

}  // namespace

void divide_far(const SourceTask& task, std::span<const uint32_t> members, const ReceiverHull& hull,
                const FlatCell& cell, ShadowScene& scene, GatherMemory& memory,
                CertifiedCounters& counters) {
  memory.parts.clear();
  FoundFacets& found = *task.request.found;
  const double radius = hull.radius();
  // Where a cell has been given up close by, it is not halved again; few receivers do not even ask.
  const bool is_over_budget = found.is_over_budget_at(hull.centre, radius);
  FarDivision division(task, members, hull, scene, memory, counters);
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
