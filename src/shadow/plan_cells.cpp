#include "shadow/plan_cells.h"

#include <algorithm>

#include "base/random.h"
#include "light/irradiance.h"

namespace troffer {

namespace {

// So many receivers have a pilot, and there are at most so many pilots.
constexpr size_t receivers_per_pilot = 24, fewest_pilots = 3, most_pilots = 8;
// A source of which pilots see nothing, though no facet hides all of it, is searched in so many
// cells more.
constexpr size_t cells_of_search = 12;
// Masks of pilots take other random numbers than those that count.
constexpr uint64_t first_pilot_pass = 1000;
// Variance of the coarse lattice over that of the fine one: (661 / 178)^1.5.
constexpr double coarse_variance = 7.2;
// Masks err by less than they tell, by a third and more as a rule.
constexpr double told_over_made = 1.4;
// What a mask costs, in facets of the fine lattice: itself, and each of them by the coarse one.
constexpr double cost_of_mask = 10, coarse_cost = 0.6;

// The plan as it grows: entries of `cells`, which coarse lattices lie over.
class Plan {
 public:
  Plan(const SourceTask& task, const SourcePart& part, uint64_t stream, PilotMemory& memory,
       SettleMemory& settle)
      : task_(task), part_(part), stream_(stream), m_(memory), settle_(settle) {
    m_.pilots.clear();
    m_.seen.clear();
    m_.facets.clear();
    const size_t members = part.members.size();
    const size_t n =
        std::min(members, std::clamp(members / receivers_per_pilot, fewest_pilots, most_pilots));
    for (size_t k = 0; k < n; ++k)
      m_.pilots.push_back(part.members[(2 * k + 1) * members / (2 * n)]);
    is_coarse_.assign(m_.cells.size(), task.options.lattice.rows < fine_lattice.rows);
    for (size_t c = 0; c < m_.cells.size(); ++c) look(c);
    most_dark_ = m_.cells.size() + cells_of_search;
  }

  // Makes the worst cell finer; false where all is well, or more would cost too much.
  bool refine() {
    const size_t cell = worst();
    if (cell == m_.cells.size() || cost() > task_.promise.budget) return false;
    if (is_coarse_[cell]) {
      is_coarse_[cell] = false;
      return true;
    }
    FlatCell first, second;
    if (m_.cells[cell].is_disk || !halve(m_.cells[cell], first, second)) return false;
    m_.cells[cell] = first;
    look(cell);
    m_.cells.push_back(second);
    is_coarse_.push_back(false);
    look(m_.cells.size() - 1);
    return true;
  }

  bool is_coarse(size_t cell) const { return is_coarse_[cell]; }

 private:
  size_t pilots() const { return m_.pilots.size(); }

  double variance(size_t cell, size_t pilot) const {
    return m_.seen[cell * pilots() + pilot].variance * (is_coarse_[cell] ? coarse_variance : 1);
  }

  double cost() const {
    double sum = 0;
    for (size_t c = 0; c < m_.cells.size(); ++c)
      if (m_.facets[c] > 0)
        sum += cost_of_mask + double(m_.facets[c]) * (is_coarse_[c] ? coarse_cost : 1);
    return sum;
  }

  // Of the pilot whose error is too large by the largest factor, the cell that adds most; the
  // number of cells where none is.
  size_t worst() const {
    const size_t n = m_.cells.size();
    double largest = 1;
    size_t pilot = pilots();
    for (size_t k = 0; k < pilots(); ++k) {
      double light = 0, sum = 0;
      for (size_t c = 0; c < n; ++c) {
        light += m_.seen[c * pilots() + k].light;
        sum += variance(c, k);
      }
      if (light == 0 && n >= most_dark_) continue;
      const double allowed = allowed_variance(m_.pilots[k], light);
      if (sum > allowed * largest) {
        largest = allowed > 0 ? sum / allowed : 1e300;
        pilot = k;
      }
    }
    if (pilot == pilots()) return n;
    size_t cell = 0;
    for (size_t c = 1; c < n; ++c)
      if (variance(c, pilot) > variance(cell, pilot)) cell = c;
    return cell;
  }

  double allowed_variance(uint32_t member, double light) const {
    const Promise& p = task_.promise;
    const double seen = double(p.seen[member]), floor = double(p.floor[member]);
    // Where a pilot sees nothing, what others send, or may send, tells how much that matters.
    constexpr double usual_share = 0.1;
    const double others = std::max(seen, usual_share * double(p.rest[member]));
    const double least = light > 0 ? floor : std::max(floor, others), all = seen + light;
    return sqr(told_over_made * double(p.error)) *
           std::max(all * std::max(light, all / (2 * p.sources)), least * least);
  }

  // What pilots see of a cell.
  void look(size_t cell);

  const SourceTask& task_;
  const SourcePart& part_;
  uint64_t stream_;
  PilotMemory& m_;
  SettleMemory& settle_;
  std::vector<bool> is_coarse_;
  size_t most_dark_ = 0;
};

void Plan::look(size_t c) {
  const FlatCell& cell = m_.cells[c];
  m_.seen.resize(m_.cells.size() * pilots());
  m_.facets.resize(m_.cells.size());
  const uint64_t stream = hash_of(stream_, m_.cells.size(), c);
  const MaskFrame frame(cell.plane, fine_lattice, (stream & 1) != 0, part_.hull.centre,
                        cell.all_outline(), cell.is_disk);
  FacetList& list = settle_.lists[0];
  list.clear();
  list.add_many(frame, part_.facets);
  list.finish();
  const CellTask task{task_, frame, task_.unoccluded, stream, part_.is_complete, false};
  FacetList& left = settle_.lists[1];
  const Certificate certificate = certify(task, part_.hull, list, settle_.flags, left);
  m_.facets[c] = certificate == Certificate::none ? left.size() : 0;
  for (size_t k = 0; k < pilots(); ++k) {
    PilotMemory::Seen& s = m_.seen[c * pilots() + k];
    s = {};
    if (certificate == Certificate::dark) continue;
    const uint32_t member = m_.pilots[k];
    const ShadowReceiver& r = task_.cluster.receivers[member];
    const double all = cell.is_disk ? double(task_.unoccluded[member])
                                    : polygon_irradiance(cell.all_corners(), Vec3d(r.position),
                                                         Vec3d(r.normal), Sides::both);
    const MaskShare share =
        certificate == Certificate::lit
            ? MaskShare{1, 0}
            : look_at_cell(task, member, left, first_pilot_pass + k, settle_.masks);
    if (share.share < 0) continue;  // hardly any light
    s.light = all * double(share.share);
    s.variance = all * all * double(share.variance);
    // Between samples that are all dark there may be light, of a sample or so.
    if (certificate == Certificate::none && share.share == 0)
      s.variance = sqr(all / fine_lattice.samples());
  }
}

}  // namespace

void plan_cells(const SourceTask& task, const SourcePart& part, uint64_t stream,
                PilotMemory& memory, SettleMemory& settle, std::vector<PlannedCell>& out) {
  out.clear();
  memory.cells.clear();
  cut_cells(part.cell, part.hull, task.options.cells, memory.cells);
  const bool has_masks = part.is_complete && !part.facets.empty();
  if (!has_masks || !(task.promise.error > 0)) {
    for (const FlatCell& c : memory.cells) out.push_back({c, task.options.lattice});
    return;
  }
  Plan plan(task, part, stream, memory, settle);
  while (plan.refine()) {
  }
  for (size_t c = 0; c < memory.cells.size(); ++c)
    out.push_back({memory.cells[c], plan.is_coarse(c) ? coarse_lattice : fine_lattice});
}

}  // namespace troffer
