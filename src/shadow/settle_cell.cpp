#include "shadow/settle_cell.h"

#include <algorithm>

#include "shadow/round_certificate.h"

namespace troffer {

Certificate certify(const SourceCellTask& cell, const ReceiverHull& hull, const FacetList& facets,
                    FacetFlags& flags, FacetList& left) {
  left.clear();
  const MaskFrame& frame = cell.frame;
  if (facets.size() > facets.round().size()) {
    MaskPoint corners[8];
    for (int i = 0; i < hull.count; ++i)
      corners[i] = mask_point(frame, frame.to_canvas(hull.corners[size_t(i)]), {0, 0});
    classify(facets, {corners, size_t(hull.count)}, float(hull.slack * frame.stretch()), flags);
    const auto hides_all = [](int32_t f) { return f == 2; };
    if (std::any_of(flags.quads.begin(), flags.quads.end(), hides_all) ||
        std::any_of(flags.triangles.begin(), flags.triangles.end(), hides_all))
      return Certificate::dark;
    left.keep_unsettled(facets, flags);
    if (!frame.is_disk()) left.find_edges_along(frame.lattice());
  }
  for (const RoundBody& body : facets.round().bodies) {
    const RoundFlag flag = classify(body, frame, hull);
    if (flag == RoundFlag::hides_all) return Certificate::dark;
    if (flag == RoundFlag::unknown) left.round().bodies.push_back(body);
  }
  const bool is_lit = left.size() == 0 && cell.is_complete && !cell.source.does_horizon_hide();
  return is_lit ? Certificate::lit : Certificate::none;
}

namespace {

void settle(const SourceCellTask& cell, ReceiverTree& tree, uint32_t node, size_t depth,
            SettleMemory& memory, SourceResults& results) {
  FacetList& left = memory.lists[depth + 1];
  const std::span<const uint32_t> members = tree.members(node);
  switch (certify(cell, tree.hull(node), memory.lists[depth], memory.flags, left)) {
    case Certificate::lit:
      for (const uint32_t m : members) add_lit(cell, m, memory.masks, results);
      return;
    case Certificate::dark:
      for (const uint32_t m : members)
        results.sums[m].add(cell.unoccluded[m], 0, 0, ShadowAnswer::dark);
      return;
    case Certificate::none:
      break;
  }
  const CertifiedOptions& o = cell.source.options;
  if (left.size() < o.split_above || members.size() < 2 * o.smallest_cluster ||
      depth >= SettleMemory::most_depth)
    return mask_cell(cell, members, left, memory.masks, results);
  const uint32_t halves = tree.halves_of(node);
  for (const uint32_t half : {halves, halves + 1})
    settle(cell, tree, half, depth + 1, memory, results);
}

}  // namespace

void settle_cell(const SourceCellTask& cell, ReceiverTree& receivers, SettleMemory& memory,
                 SourceResults& results) {
  settle(cell, receivers, 0, 0, memory, results);
}

}  // namespace troffer
