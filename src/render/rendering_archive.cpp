#include "render/rendering_archive.h"

#include <algorithm>
#include <cstring>

#include "base/error.h"

namespace troffer {

namespace {

// In place of a tile's number: the chunk holds the plan of further rays.
constexpr uint32_t plan_chunk = 0xffffffff;

// Head of a chunk of a checkpoint.
struct TileHeader {
  uint32_t tile, steps;
  Counters counters;
};
static_assert(sizeof(TileHeader) == 112 && sizeof(Counters) == 104);

// Head of a message.
struct StateHeader {
  uint32_t steps = 0, unused = 0;
  Counters counters;
};

template <class Visit>
void for_pixels(const PixelRect& r, const Visit& visit) {
  for (int y = r.y0; y < r.y1; ++y)
    for (int x = r.x0; x < r.x1; ++x) visit(x, y);
}

}  // namespace

void RenderingArchive::save_tile(size_t tile, std::vector<uint8_t>& out) const {
  for_pixels(plan_.tiles[tile], [&](int x, int y) {
    film_.save(x, y, out);
    if (further_.is_refined()) further_.records()->save(x, y, out);
  });
}

void RenderingArchive::save(Checkpoint& checkpoint) const {
  checkpoint.write([&](const Checkpoint::Add& add) {
    std::vector<uint8_t> chunk;
    for (size_t t = 0; t < book_.size(); ++t) {
      chunk.clear();
      append(chunk, TileHeader{});
      const TileBook::State state = book_.snapshot(
          t, [&](std::vector<uint8_t>& out) { save_tile(t, out); }, chunk);
      if (state.steps == 0) continue;
      const TileHeader header{uint32_t(t), state.steps, state.counters};
      std::memcpy(chunk.data(), &header, sizeof(header));
      add(chunk);
    }
    if (!further_.are_decided()) return;
    chunk.clear();
    append(chunk, plan_chunk);
    for (size_t i = 0; i < further_.pixels(); ++i) append(chunk, further_.at(i));
    add(chunk);
  });
}

void RenderingArchive::restore(Checkpoint& checkpoint) {
  const auto number_of = [&](std::span<const uint8_t> chunk) {
    if (chunk.size() < sizeof(uint32_t)) checkpoint.refuse_chunks();
    return ByteReader(chunk).next<uint32_t>();
  };
  bool is_sound = true;
  for (const bool is_plan : {true, false})
    for (const std::span<const uint8_t> chunk : checkpoint.chunks())
      if ((number_of(chunk) == plan_chunk) == is_plan)
        is_sound = is_sound &&
                   (is_plan ? restore_plan(ByteReader(chunk)) : restore_tile(ByteReader(chunk)));
  if (!is_sound) checkpoint.refuse_chunks();
  checkpoint.forget_chunks();
}

bool RenderingArchive::restore_plan(ByteReader in) {
  in.next<uint32_t>();
  if (!further_.is_refined() || further_.are_decided()) return false;
  if (in.left() != further_.pixels() * sizeof(WantedPixel)) return false;
  std::vector<WantedPixel> wanted;
  for (size_t i = 0; i < further_.pixels(); ++i) wanted.push_back(in.next<WantedPixel>());
  return further_.restore(std::move(wanted));
}

// True if the pixel has the numbers of samples that these steps produce.
bool RenderingArchive::is_as_expected(uint32_t steps, int x, int y) const {
  const TileSteps& all = further_.steps();
  const auto first = uint32_t(further_.first_spp());
  uint32_t samples = std::min(first, steps * samples_per_pass), surrogates = 0;
  if (steps > all.first) {
    const WantedPixel& wanted = further_.at(x, y);
    const uint32_t more = steps - all.first;
    if (further_.are_at_once()) {
      surrogates = wanted.surrogates;
      // FurtherChoice changes the planned number.
      if (more > all.surrogates) samples = std::max(film_.estimate(x, y).samples, first);
    } else {
      samples = std::min(wanted.samples, first + more * samples_per_pass);
    }
  }
  return film_.estimate(x, y).samples == samples && film_.surrogates(x, y) == surrogates;
}

bool RenderingArchive::restore_tile(ByteReader in) {
  if (in.left() < sizeof(TileHeader)) return false;
  const auto h = in.next<TileHeader>();
  const TileSteps& all = further_.steps();
  if (h.tile >= book_.size() || book_.steps(h.tile) != 0 || h.steps == 0 || h.steps > all.all() ||
      (h.steps > all.first && !further_.are_decided()))
    return false;
  const PixelRect& r = plan_.tiles[h.tile];
  for (int y = r.y0; y < r.y1; ++y)
    for (int x = r.x0; x < r.x1; ++x) {
      if (in.left() < film_.bytes_of_pixel() || !film_.load(x, y, in)) return false;
      if (further_.is_refined() && !further_.records()->load(x, y, in)) return false;
      if (!is_as_expected(h.steps, x, y)) return false;
    }
  book_.restore(h.tile, {h.steps, h.counters});
  return in.left() == 0;
}

void RenderingArchive::send_tile(size_t tile, std::vector<uint8_t>& out) const {
  const TileBook::State& state = book_.state(tile);
  append(out, StateHeader{state.steps, 0, state.counters});
  for_pixels(plan_.tiles[tile], [&](int x, int y) {
    film_.save(x, y, out);
    if (further_.is_recording()) further_.records()->save(x, y, out);
  });
}

TileBook::State RenderingArchive::received_state(ByteReader& in) {
  const auto h = in.next<StateHeader>();
  return {h.steps, h.counters};
}

void RenderingArchive::load_pixels(size_t tile, ByteReader& in) {
  for_pixels(plan_.tiles[tile], [&](int x, int y) {
    TROFFER_CHECK(film_.load(x, y, in));
    if (further_.is_recording()) TROFFER_CHECK(further_.records()->load(x, y, in));
  });
}

void RenderingArchive::send_brief(size_t tile, std::vector<uint8_t>& out) const {
  send_tile(tile, out);
  if (!further_.has_begun()) return;
  for_pixels(plan_.tiles[tile], [&](int x, int y) { append(out, further_.at(x, y)); });
}

void RenderingArchive::receive_brief(size_t tile, ByteReader in) {
  book_.restore(tile, received_state(in));
  load_pixels(tile, in);
  if (!further_.has_begun()) return;
  for_pixels(plan_.tiles[tile], [&](int x, int y) {
    further_.set(further_.records()->index(x, y), in.next<WantedPixel>());
  });
}

void RenderingArchive::send_records(std::vector<uint8_t>& out) const {
  for_pixels(further_.records()->window,
             [&](int x, int y) { further_.records()->save(x, y, out); });
}

void RenderingArchive::receive_records(ByteReader in) {
  for_pixels(further_.records()->window,
             [&](int x, int y) { TROFFER_CHECK(further_.records()->load(x, y, in)); });
}

}  // namespace troffer
