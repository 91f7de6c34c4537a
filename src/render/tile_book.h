// Progress of a rendering's tiles, kept so that a consistent snapshot is possible at any moment:
// for a tile in progress, its state before the current step. Used by Rendering for checkpoints and
// process groups.
//
// A tile goes through steps 0, 1, 2 and so on, one per pass over the picture.
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
    uint32_t steps = 0;  // number of steps done
    Counters counters;   // work of these steps
  };
  // Appends the bytes of a tile's pixels.
  using Pixels = std::function<void(std::vector<uint8_t>&)>;

  // has_copies: snapshot() will be called.
  TileBook(size_t tiles, size_t slots, bool has_copies)
      : states_(tiles), busy_(slots), has_copies_(has_copies) {}

  size_t size() const { return states_.size(); }
  uint32_t steps(size_t tile) const { return states_[tile].steps; }
  const State& state(size_t tile) const { return states_[tile]; }
  Counters counters() const;  // sum over all tiles

  // Declares that the thread of this slot will change the tile's pixels.
  void begin(size_t tile, size_t slot, const Pixels& pixels);
  // Declares that it has finished the tile's next step, with this work.
  void finish(size_t slot, const Counters& counters);

  // Sets a tile's state, for a rendering that continues an earlier one. No thread may work on it.
  void restore(size_t tile, const State& state) { states_[tile] = state; }
  // The same while other threads are at work: load() must set the pixels to that state.
  void replace(size_t tile, const State& state, const std::function<void()>& load);
  // Returns the tile's state after its last finished step, and appends its pixels to `out`. For any
  // thread.
  State snapshot(size_t tile, const Pixels& pixels, std::vector<uint8_t>& out) const;

 private:
  static constexpr size_t none = ~size_t(0);
  struct Busy {
    size_t tile = none;
    std::vector<uint8_t> before;
  };

  std::vector<State> states_;
  std::vector<Busy> busy_;  // per slot
  bool has_copies_;
  mutable std::mutex mutex_;
};

}  // namespace troffer
