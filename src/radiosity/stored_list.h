// The most important contributions to one sample point, updated as they arrive. StoredLists keeps
// one list per point, and the solution stores them. Contributions that do not fit go to the point's
// general value.
#pragma once

#include <algorithm>
#include <span>

#include "radiosity/solution.h"

namespace troffer {

constexpr float hidden_importance = 0.25f;

// Rank of a contribution: the light that arrives, or a quarter of the unoccluded light of a hidden
// source, because the edge of its shadow may be near.
inline float importance(const StoredContribution& c) {
  return std::max(luminance(c.received), hidden_importance * luminance(c.unoccluded));
}

// General value of a point: contributions that are not stored separately.
struct General {
  Rgb& all;
  Rgb& direct;
  void add(Rgb received, bool is_light) const {
    all += received;
    if (is_light) direct += received;
  }
};

// Adds a contribution to the source's entry or to a free one. Otherwise it replaces the least
// important entry, which moves to the general value; if the new one is the least important, it goes
// there. A source that shoots again after it was moved starts from zero.
inline void keep(std::span<StoredContribution> list, const General& general, uint32_t light_count,
                 const StoredContribution& c) {
  for (StoredContribution& entry : list) {
    if (entry.source == c.source) {
      entry.received += c.received;
      entry.unoccluded += c.unoccluded;
      return;
    }
    if (entry.source == no_source) {
      entry = c;
      return;
    }
  }
  StoredContribution* least = nullptr;
  float least_importance = importance(c);
  for (StoredContribution& entry : list) {
    const float i = importance(entry);
    if (i >= least_importance) continue;
    least_importance = i;
    least = &entry;
  }
  if (least == nullptr) {
    general.add(c.received, c.source < light_count);
    return;
  }
  general.add(least->received, least->source < light_count);
  *least = c;
}

}  // namespace troffer
