// The most important contributions to one sample point, kept as they come in.
#pragma once

#include <algorithm>
#include <span>

#include "radiosity/solution.h"

namespace troffer {

constexpr float hidden_importance = 0.25f;

// By which contributions are ranked: what arrives, but a strong source that is hidden here counts
// for a quarter of what it would send, since its shadow's edge may be near.
inline float importance(const StoredContribution& c) {
  return std::max(luminance(c.received), hidden_importance * luminance(c.unoccluded));
}

// What is not kept at a point.
struct General {
  Rgb& all;
  Rgb& direct;
  void add(Rgb received, bool is_light) const {
    all += received;
    if (is_light) direct += received;
  }
};

// Adds to the source's entry, to a free one, or instead of the least important one, which moves to
// the general value; into the general value if it is the least important itself. A source that
// shoots again after it was moved counts anew.
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
