#include "render/tile_book.h"

#include <algorithm>

namespace troffer {

Counters TileBook::counters() const {
  Counters sum;
  for (const State& s : states_) sum += s.counters;
  return sum;
}

void TileBook::begin(size_t tile, size_t slot, const Pixels& pixels) {
  Busy& busy = busy_[slot];
  if (has_copies_) {
    busy.before.clear();
    pixels(busy.before);
  }
  const std::lock_guard lock(mutex_);
  busy.tile = tile;
}

void TileBook::finish(size_t slot, const Counters& counters) {
  const std::lock_guard lock(mutex_);
  State& state = states_[busy_[slot].tile];
  ++state.steps;
  state.counters += counters;
  busy_[slot].tile = none;
}

void TileBook::replace(size_t tile, const State& state, const std::function<void()>& load) {
  const std::lock_guard lock(mutex_);
  load();
  states_[tile] = state;
}

// No thread can begin to change a tile while the lock is held.
TileBook::State TileBook::snapshot(size_t tile, const Pixels& pixels,
                                   std::vector<uint8_t>& out) const {
  const std::lock_guard lock(mutex_);
  const auto busy =
      std::find_if(busy_.begin(), busy_.end(), [tile](const Busy& b) { return b.tile == tile; });
  if (busy == busy_.end())
    pixels(out);
  else
    out.insert(out.end(), busy->before.begin(), busy->before.end());
  return states_[tile];
}

}  // namespace troffer
