// The stored contributions of all sample points on their way, with what a quick look at them needs.
#pragma once

#include <limits>
#include <vector>

#include "radiosity/stored_list.h"

namespace troffer {

class StoredLists {
 public:
  // Into the solution's lists and general values, which must have their sizes.
  explicit StoredLists(RadiositySolution& solution)
      : solution_(solution),
        sources_(solution.stored.size(), no_source),
        least_(solution.mesh.points.size(), 0.0f) {}

  // rank: its importance. False: what the source gives goes to the general value.
  bool takes(uint32_t point, uint32_t source, float rank) const {
    return rank > least_[point] || is_stored(point, source);
  }

  void add(uint32_t point, const StoredContribution& c) {
    RadiositySolution& s = solution_;
    const size_t first = size_t(point) * s.stored_per_point;
    const std::span<StoredContribution> list(s.stored.data() + first, s.stored_per_point);
    keep(list, {s.general[point], s.general_direct[point]}, s.light_count, c);
    float least = list.empty() ? std::numeric_limits<float>::infinity() : importance(list[0]);
    for (size_t k = 0; k < list.size(); ++k) {
      sources_[first + k] = list[k].source;
      least = std::min(least, list[k].source == no_source ? -1.0f : importance(list[k]));
    }
    least_[point] = least;
  }

 private:
  bool is_stored(uint32_t point, uint32_t source) const {
    const uint32_t* sources = sources_.data() + size_t(point) * solution_.stored_per_point;
    bool is_found = false;
    for (uint32_t k = 0; k < solution_.stored_per_point; ++k) is_found |= sources[k] == source;
    return is_found;
  }

  RadiositySolution& solution_;
  std::vector<uint32_t> sources_;  // of solution_.stored
  std::vector<float> least_;       // per point: importance below which nothing new is stored
};

}  // namespace troffer
