// A rendering that several processes work on (rendering.h, base/process_group.h). Each process has
// its own film; that of rank 0 receives all tiles.
#include "base/error.h"
#include "base/process_group.h"
#include "render/rendering.h"

namespace troffer {

namespace {

struct StateHeader {
  uint32_t steps = 0, unused = 0;
  Counters counters;
};

}  // namespace

bool Rendering::leads() const {
  return options_.group == nullptr || options_.group->leads();
}

// Returns rank 0's value to all processes.
bool Rendering::agree(bool value) {
  if (options_.group == nullptr) return value;
  std::vector<uint8_t> bytes{uint8_t(value)};
  if (options_.group->tell(bytes, stop_)) return bytes.front() != 0;
  progress_.was_stopped = true;
  return false;
}

// Without limits, a tile does as many steps at a time as possible, which saves messages. A picture
// that may have to end early advances evenly instead.
void Rendering::agree_on_limits() {
  if (options_.group != nullptr) refining_.is_stepwise = agree(is_limited());
}

// Records are part of it only during the first passes; later ones do not change them.
void Rendering::save_for_group(size_t tile, std::vector<uint8_t>& out) const {
  const TileBook::State& state = book_.state(tile);
  append(out, StateHeader{state.steps, 0, state.counters});
  const PixelRect& r = plan_.tiles[tile];
  for (int y = r.y0; y < r.y1; ++y)
    for (int x = r.x0; x < r.x1; ++x) {
      film_.save(x, y, out);
      if (refining_.records && !refining_.has_begun) refining_.records->save(x, y, out);
    }
}

// Reads the pixels after a header.
void Rendering::load_from_group(size_t tile, ByteReader& in) {
  const PixelRect& r = plan_.tiles[tile];
  for (int y = r.y0; y < r.y1; ++y)
    for (int x = r.x0; x < r.x1; ++x) {
      TROFFER_CHECK(film_.load(x, y, in));
      if (refining_.records && !refining_.has_begun)
        TROFFER_CHECK(refining_.records->load(x, y, in));
    }
}

// Takes over a tile that another process has worked on; called by rank 0.
void Rendering::take_over(size_t tile, ByteReader in) {
  const auto h = in.next<StateHeader>();
  const uint32_t before = book_.steps(tile);
  book_.replace(tile, {h.steps, h.counters}, [&] { load_from_group(tile, in); });
  for (uint32_t s = before; s < h.steps; ++s) tell_progress(tile, s);
}

// Appends the state of a tile and the rays planned for it.
void Rendering::brief(size_t tile, std::vector<uint8_t>& out) const {
  save_for_group(tile, out);
  if (!refining_.has_begun) return;
  const PixelRect& r = plan_.tiles[tile];
  for (int y = r.y0; y < r.y1; ++y)
    for (int x = r.x0; x < r.x1; ++x) {
      const size_t i = refining_.records->index(x, y);
      append(out, refining_.wanted->at(i));
    }
}

void Rendering::take_brief(size_t tile, ByteReader in) {
  const auto h = in.next<StateHeader>();
  book_.restore(tile, {h.steps, h.counters});
  load_from_group(tile, in);
  if (!refining_.has_begun) return;
  const PixelRect& r = plan_.tiles[tile];
  for (int y = r.y0; y < r.y1; ++y)
    for (int x = r.x0; x < r.x1; ++x) {
      const size_t i = refining_.records->index(x, y);
      refining_.wanted->set(i, in.next<WantedPixel>());
    }
}

void Rendering::share_steps(const StepSpan& steps, const Tiles& tiles, const Act& act) {
  SharedWork work;
  work.items = book_.size();
  work.threads = options_.threads;
  work.is_for_all = false;
  work.has_order = leads();
  for (const size_t t : tiles)
    if (leads() && book_.steps(t) >= steps.first && book_.steps(t) < steps.end)
      work.order.push_back(t);
  work.act = [&](size_t t, size_t slot) {
    for (uint32_t number = book_.steps(t); number < steps.end; ++number)
      if (!do_step(number, t, slot, act)) return false;
    return true;
  };
  work.save = [&](size_t t, SharedWork::Bytes& out) { save_for_group(t, out); };
  work.load = [&](size_t t, ByteReader in) { take_over(t, in); };
  work.brief = [&](size_t t, SharedWork::Bytes& out) {
    if (book_.steps(t) > 0) brief(t, out);
  };
  work.take_brief = [&](size_t t, ByteReader in) {
    if (in.left() > 0) take_brief(t, in);
  };
  if (!options_.group->share(work, stop_)) progress_.was_stopped = true;
}

// Gives all processes the records of the first pass: patterns are compared with those of
// neighbours, which another process may have computed.
void Rendering::share_records() {
  PixelRecords& records = *refining_.records;
  const PixelRect& r = records.window;
  std::vector<uint8_t> bytes;
  for (int y = r.y0; leads() && y < r.y1; ++y)
    for (int x = r.x0; x < r.x1; ++x) records.save(x, y, bytes);
  if (!options_.group->tell(bytes, stop_)) {
    progress_.was_stopped = true;
    return;
  }
  ByteReader in(bytes);
  for (int y = r.y0; !leads() && y < r.y1; ++y)
    for (int x = r.x0; x < r.x1; ++x) TROFFER_CHECK(records.load(x, y, in));
}

}  // namespace troffer
