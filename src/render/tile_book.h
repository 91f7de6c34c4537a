// How far each tile of a rendering is, kept such that a rendering under way can be told whole at
// any moment: of a tile that a thread is busy with, as it was before.
//
// A tile goes through steps, 0, 1, 2 …: a pass of the picture each.
#pragma once

#include <cstdint>
#include <functional>
#include <mutex>
#include <vector>

#include "transport/batch.h"

namespace troffer {

class TileBook {
 public:
  struct State {
    uint32_t steps = 0;  // done
    Counters counters;   // of these
  };
  // What a tile's pixels are, as bytes.
  using Pixels = std::function<void(std::vector<uint8_t>&)>;

  // has_copies: snapshot() will be called.
  TileBook(size_t tiles, size_t slots, bool has_copies)
      : states_(tiles), busy_(slots), has_copies_(has_copies) {}

  size_t size() const { return states_.size(); }
  uint32_t steps(size_t tile) const { return states_[tile].steps; }
  const State& state(size_t tile) const { return states_[tile]; }
  Counters counters() const;  // of all that is done

  // The thread of this slot is about to change the tile's pixels …
  void begin(size_t tile, size_t slot, const Pixels& pixels);
  // … and has done its next step, with so much work.
  void finish(size_t slot, const Counters& counters);

  // For who goes on with what another has begun; while no thread is busy with the tile.
  void restore(size_t tile, const State& state) { states_[tile] = state; }
  // The same while others are at work: load() is to make its pixels what they are then.
  void replace(size_t tile, const State& state, const std::function<void()>& load);
  // A tile as it was when it had last done a step, its pixels added to `out`. By any thread.
  State snapshot(size_t tile, const Pixels& pixels, std::vector<uint8_t>& out) const;

 private:
  static constexpr size_t none = ~size_t(0);
  struct Busy {
    size_t tile = none;
    std::vector<uint8_t> before;
  };

  std::vector<State> states_;
  std::vector<Busy> busy_;  // by slots
  bool has_copies_;
  mutable std::mutex mutex_;
};

}  // namespace troffer
