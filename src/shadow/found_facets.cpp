#include "shadow/found_facets.h"

#include <algorithm>

namespace troffer {

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

bool FoundFacets::is_over_budget_at(const Vec3d& centre, double radius) const {
  return std::any_of(over_budget_.begin(), over_budget_.end(), [&](const Place& p) {
    return length(p.centre - centre) <= 2 * (p.radius + radius);
  });
}

void FoundFacets::trim(size_t most) {
  std::stable_sort(entries_.begin(), entries_.end(),
                   [](const Entry& a, const Entry& b) { return a.hits > b.hits; });
  if (entries_.size() > most) entries_.resize(most);
  for (Entry& e : entries_) e.hits = (e.hits + 1) / 2;
}

}  // namespace troffer
