#include "shadow/plan_cells.h"

#include <algorithm>

#include "base/random.h"
#include "light/irradiance.h"
#include "shadow/cell_facets.h"

namespace troffer {

namespace {

// Receivers per pilot receiver, and limits of the number of pilot receivers.
constexpr size_t receivers_per_pilot = 24, fewest_pilots = 3, most_pilots = 8;
// Further cells that are searched if pilots see nothing of a source, although no facet hides all of
// it.
constexpr size_t cells_of_search = 12;
// Pass numbers of pilot masks, which keep their random numbers apart from those of final masks.
constexpr uint64_t first_pilot_pass = 1000;
// Variance of the coarse lattice over that of the fine one: (661 / 178)^1.5.
constexpr double coarse_variance = 7.2;
// Estimated over actual error of masks.
constexpr double told_over_made = 1.3;
// Cost of a mask in facets of the fine lattice, and cost of a facet by the coarse lattice.
constexpr double cost_of_mask = 10, coarse_cost = 0.6;

std::span<const FacetToAdd> facets_of(const SourcePart& part, const PilotMemory& memory,
                                      size_t cell) {
  return memory.has_own_facets[cell] != 0 ? memory.facets[cell] : part.facets;
}

// The growing plan: cells with their lattices, and sums over them.
class Plan {
 public:
  Plan(const SourceTask& task, const SourcePart& part, uint64_t stream, PilotMemory& memory,
       SettleMemory& settle)
      : task_(task), part_(part), stream_(stream), m_(memory), settle_(settle) {
    const size_t members = part.members.size();
    const size_t n =
        std::min(members, std::clamp(members / receivers_per_pilot, fewest_pilots, most_pilots));
    m_.pilots.assign(n, {});
    for (size_t k = 0; k < n; ++k)
      m_.pilots[k].member = part.members[(2 * k + 1) * members / (2 * n)];
    m_.costs.clear();
    m_.is_coarse.clear();
    m_.has_own_facets.assign(m_.cells.size(), m_.cells.size() > 1 ? 1 : 0);
    m_.facets.resize(std::max(m_.facets.size(), m_.cells.size()));
    for (size_t c = 0; c < m_.cells.size() && m_.cells.size() > 1; ++c)
      facets_for_cell(part.hull, m_.cells[c], part.facets, m_.facets[c]);
    const size_t first = m_.cells.size();
    const bool is_coarse = task.options.lattice.rows < fine_lattice.rows;
    for (size_t c = 0; c < first; ++c) look(c, is_coarse);
    most_dark_ = first + cells_of_search;
  }

  // Refines the worst cell. Returns false if the error is small enough, or if more would cost too
  // much.
  bool refine() {
    const size_t cell = worst();
    if (cell == m_.cells.size() || cost_ > task_.promise.budget) return false;
    if (m_.is_coarse[cell] != 0) {
      count(cell, -1);
      m_.is_coarse[cell] = 0;
      count(cell, 1);
      return true;
    }
    FlatCell first, second;
    if (m_.cells[cell].is_disk || !halve(m_.cells[cell], first, second)) return false;
    count(cell, -1);
    divide_facets(cell, first, second);
    m_.cells[cell] = first;
    look(cell, false);
    m_.cells.push_back(second);
    look(m_.cells.size() - 1, false);
    return true;
  }

 private:
  double variance(const PilotMemory::Pilot& pilot, size_t cell) const {
    return pilot.variance[cell] * (m_.is_coarse[cell] != 0 ? coarse_variance : 1);
  }

  // Adds the cell to all sums (sign 1), or removes it (sign -1).
  void count(size_t cell, double sign) {
    cost_ += sign * m_.costs[cell] * (m_.is_coarse[cell] != 0 ? coarse_cost : 1);
    for (PilotMemory::Pilot& p : m_.pilots) {
      p.all_light += sign * p.light[cell];
      p.all_variance += sign * variance(p, cell);
    }
  }

  // Returns the cell with the largest variance for the pilot that exceeds its limit most. Returns
  // the number of cells if no pilot exceeds its limit.
  size_t worst() const {
    const size_t n = m_.cells.size();
    double largest = 1;
    const PilotMemory::Pilot* pilot = nullptr;
    for (const PilotMemory::Pilot& p : m_.pilots) {
      const double light = std::max(p.all_light, 0.0);
      if (light == 0 && n >= most_dark_) continue;
      const double allowed = allowed_variance(p.member, light);
      if (p.all_variance > allowed * largest) {
        largest = allowed > 0 ? p.all_variance / allowed : 1e300;
        pilot = &p;
      }
    }
    if (pilot == nullptr) return n;
    size_t cell = 0;
    for (size_t c = 1; c < n; ++c)
      if (variance(*pilot, c) > variance(*pilot, cell)) cell = c;
    return variance(*pilot, cell) > 0 ? cell : n;
  }

  double allowed_variance(uint32_t member, double light) const {
    const MaskBudget& p = task_.promise;
    const double seen = double(p.seen[member]), floor = double(p.floor[member]);
    // If a pilot sees nothing of this source, the light of other sources decides how much that
    // matters.
    constexpr double usual_share = 0.1;
    const double others = std::max(seen, usual_share * double(p.rest[member]));
    const double least = light > 0 ? floor : std::max(floor, others), all = seen + light;
    return sqr(told_over_made * double(p.error)) *
           std::max(all * std::max(light, all / (2 * p.sources)), least * least);
  }

  // Gives the halves of a cell their own lists.
  void divide_facets(size_t cell, const FlatCell& first, const FlatCell& second) {
    const size_t n = m_.cells.size();
    if (m_.facets.size() <= n) m_.facets.resize(n + 1);
    m_.has_own_facets.push_back(1);
    facets_for_cell(part_.hull, second, facets_of(part_, m_, cell), m_.facets[n]);
    facets_for_cell(part_.hull, first, facets_of(part_, m_, cell), kept_);
    m_.facets[cell].swap(kept_);
    m_.has_own_facets[cell] = 1;
  }

  // Masks a cell for all pilots and adds the results.
  void look(size_t cell, bool is_coarse);

  const SourceTask& task_;
  const SourcePart& part_;
  uint64_t stream_;
  PilotMemory& m_;
  SettleMemory& settle_;
  double cost_ = 0;
  size_t most_dark_ = 0;
  std::vector<FacetToAdd> kept_;
};

void Plan::look(size_t c, bool is_coarse) {
  const FlatCell& cell = m_.cells[c];
  m_.costs.resize(m_.cells.size());
  m_.is_coarse.resize(m_.cells.size());
  m_.is_coarse[c] = is_coarse ? 1 : 0;
  const uint64_t stream = hash_of(stream_, m_.cells.size(), c);
  const MaskFrame frame(cell.plane, fine_lattice, (stream & 1) != 0, part_.hull.centre,
                        cell.all_outline(), cell.is_disk);
  FacetList& list = settle_.lists[0];
  list.clear();
  list.round().bodies = part_.rounds;
  list.add_many(frame, facets_of(part_, m_, c));
  list.finish();
  const SourceCellTask task{task_, frame, task_.unoccluded, stream, part_.is_complete, false};
  FacetList& left = settle_.lists[1];
  const Certificate certificate = certify(task, part_.hull, list, settle_.flags, left);
  m_.costs[c] = certificate == Certificate::none ? cost_of_mask + double(left.size()) : 0;
  for (size_t k = 0; k < m_.pilots.size(); ++k) {
    PilotMemory::Pilot& p = m_.pilots[k];
    p.light.resize(m_.cells.size());
    p.variance.resize(m_.cells.size());
    p.light[c] = p.variance[c] = 0;
    if (certificate == Certificate::dark) continue;
    const ShadowReceiver& r = task_.cluster.receivers[p.member];
    const double all = cell.is_disk ? double(task_.unoccluded[p.member])
                                    : polygon_irradiance(cell.all_corners(), Vec3d(r.position),
                                                         Vec3d(r.normal), Sides::both);
    const MaskShare share =
        certificate == Certificate::lit
            ? MaskShare{1, 0}
            : mask_share_of(task, p.member, left, first_pilot_pass + k, settle_.masks);
    if (share.share < 0) continue;  // hardly any light
    p.light[c] = all * double(share.share);
    p.variance[c] = all * all * double(share.variance);
    // A part of about one sample between dark samples may be lit.
    if (certificate == Certificate::none && share.share == 0)
      p.variance[c] = sqr(all / fine_lattice.samples());
  }
  count(c, 1);
}

}  // namespace

void plan_cells(const SourceTask& task, const SourcePart& part, uint64_t stream,
                PilotMemory& memory, SettleMemory& settle, std::vector<PlannedCell>& out) {
  out.clear();
  memory.cells.clear();
  cut_cells(part.cell, part.hull, task.options.cells, memory.cells);
  const bool has_masks = part.is_complete && !(part.facets.empty() && part.rounds.empty());
  if (!has_masks || !(task.promise.error > 0)) {
    for (const FlatCell& c : memory.cells) out.push_back({c, task.options.lattice, part.facets});
    return;
  }
  Plan plan(task, part, stream, memory, settle);
  while (plan.refine()) {
  }
  for (size_t c = 0; c < memory.cells.size(); ++c)
    out.push_back({memory.cells[c], memory.is_coarse[c] != 0 ? coarse_lattice : fine_lattice,
                   facets_of(part, memory, c)});
}

}  // namespace troffer
