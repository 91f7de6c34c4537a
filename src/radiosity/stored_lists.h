// Stored contributions of all sample points during the solution, with summaries for quick
// rejection. The solver adds each shot's contributions to it. Importance is luminance of irradiance
// (stored_list.h).
#pragma once

#include <array>
#include <limits>
#include <vector>

#include "radiosity/receivers.h"
#include "radiosity/stored_list.h"

namespace troffer {

class StoredLists {
 public:
  // Writes to the solution's lists and general values, which must have their final sizes.
  StoredLists(RadiositySolution& solution, const Receivers& receivers)
      : solution_(solution),
        blocks_(receivers.blocks),
        slots_(receivers.slots()),
        sources_(slots_ * solution.stored_per_point, no_source),
        least_(slots_, 0.0f),
        block_(solution.mesh.points.size(), 0),
        least_in_block_(blocks_.size(), 0.0f),
        may_hold_(blocks_.size(), Sources{}) {
    for (uint32_t b = 0; b < blocks_.size(); ++b)
      for (uint32_t i = 0; i < blocks_[b].count; ++i) block_[blocks_[b].first_point + i] = b;
  }

  // Per block: importance below which none of its points stores a new contribution.
  std::span<const float> least_in_block() const { return least_in_block_; }

  // True if the point's list stores a contribution of this rank; false if it goes to the general
  // value.
  bool takes(uint32_t slot, uint32_t source, float rank) const {
    if (rank > least_[slot]) return true;
    bool is_stored = false;
    for (uint32_t k = 0; k < solution_.stored_per_point; ++k)
      is_stored |= sources_[k * slots_ + slot] == source;
    return is_stored;
  }
  // Returns false if no point of a block takes the contribution of a source; `most` is its highest
  // rank in the block. This quick test avoids reading the lists, which are far apart in memory.
  bool may_take(uint32_t block, uint32_t source, float most) const {
    return most > least_in_block_[block] ||
           (may_hold_[block][word_of(source)] & bit_of(source)) != 0;
  }

  // Adds a contribution to a point. look_over() of its block must follow before the next
  // may_take().
  void add(uint32_t point, const StoredContribution& c) {
    RadiositySolution& s = solution_;
    const size_t first = size_t(point) * s.stored_per_point;
    const std::span<StoredContribution> list(s.stored.data() + first, s.stored_per_point);
    const uint32_t block = block_[point];
    const uint32_t slot = blocks_[block].first_slot + (point - blocks_[block].first_point);
    keep(list, {s.general[point], s.general_direct[point]}, s.light_count, c);
    float least = list.empty() ? std::numeric_limits<float>::infinity() : importance(list[0]);
    for (size_t k = 0; k < list.size(); ++k) {
      sources_[k * slots_ + slot] = list[k].source;
      least = std::min(least, list[k].source == no_source ? -1.0f : importance(list[k]));
    }
    least_[slot] = least;
  }

  void look_over(uint32_t block) {
    const ReceiverBlock& b = blocks_[block];
    const auto first = least_.begin() + b.first_slot;
    least_in_block_[block] = *std::min_element(first, first + b.count);
    Sources held{};
    for (uint32_t k = 0; k < solution_.stored_per_point; ++k)
      for (uint32_t i = 0; i < b.count; ++i) {
        const uint32_t source = sources_[k * slots_ + b.first_slot + i];
        held[word_of(source)] |= bit_of(source);
      }
    may_hold_[block] = held;
  }

 private:
  using Sources = std::array<uint64_t, 4>;  // Bloom filter with one bit per source modulo 256
  static uint64_t bit_of(uint32_t source) { return uint64_t(1) << (source & 63); }
  static size_t word_of(uint32_t source) { return (source >> 6) & 3; }

  RadiositySolution& solution_;
  const std::vector<ReceiverBlock>& blocks_;
  size_t slots_;
  std::vector<uint32_t> sources_;  // sources of solution_.stored, entry by entry: [entry][slot]
  std::vector<float> least_;       // per slot: importance below which no new contribution is stored
  std::vector<uint32_t> block_;    // per point
  std::vector<float> least_in_block_;
  std::vector<Sources> may_hold_;  // per block: sources in its lists
};

}  // namespace troffer
