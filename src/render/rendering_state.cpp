// Saving a rendering as chunks of a checkpoint, and restoring it (rendering.h).
#include <bit>

#include "base/error.h"
#include "render/checkpoint.h"
#include "render/rendering.h"

namespace troffer {

namespace {

// In place of a tile's number: the chunk holds the plan of further rays.
constexpr uint32_t wanted_chunk = 0xffffffff;

struct TileHeader {
  uint32_t tile, steps;
  Counters counters;
};
static_assert(sizeof(TileHeader) == 80 && sizeof(Counters) == 72);

}  // namespace

void Rendering::save_tile(size_t tile, std::vector<uint8_t>& out) const {
  const PixelRect& r = plan_.tiles[tile];
  for (int y = r.y0; y < r.y1; ++y)
    for (int x = r.x0; x < r.x1; ++x) {
      film_.save(x, y, out);
      if (refining_.records) refining_.records->save(x, y, out);
    }
}

// Writes tiles one by one, while others are being worked on. This is consistent: a tile depends on
// others only after all have finished a step, and restoring reproduces that state.
void Rendering::save() {
  options_.checkpoint->write([&](const Checkpoint::Add& add) {
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
    if (!refining_.wanted) return;
    chunk.clear();
    append(chunk, wanted_chunk);
    for (size_t i = 0; i < refining_.wanted->samples.size(); ++i)
      append(chunk, refining_.wanted->at(i));
    add(chunk);
  });
}

void Rendering::restore() {
  const auto number_of = [&](std::span<const uint8_t> chunk) {
    if (chunk.size() < sizeof(uint32_t)) options_.checkpoint->refuse_chunks();
    return ByteReader(chunk).next<uint32_t>();
  };
  bool is_sound = true;
  for (const bool is_of_wanted : {true, false})
    for (const std::span<const uint8_t> chunk : options_.checkpoint->chunks())
      if ((number_of(chunk) == wanted_chunk) == is_of_wanted)
        is_sound = is_sound && (is_of_wanted ? restore_wanted(ByteReader(chunk))
                                             : restore_tile(ByteReader(chunk)));
  if (!is_sound) options_.checkpoint->refuse_chunks();
  options_.checkpoint->forget_chunks();
  for (size_t t = 0; t < book_.size(); ++t) {
    const uint32_t steps = book_.steps(t);
    if (steps > 0) progress_.gaps -= common_pixels(plan_.tiles[t], plan_.window);
    progress_.tiles_done += steps - (steps > steps_.first ? steps_.surrogates : 0);
  }
}

bool Rendering::restore_wanted(ByteReader in) {
  in.next<uint32_t>();
  if (!refining_.records || refining_.wanted) return false;
  const size_t pixels = refining_.records->records.size();
  if (in.left() != pixels * sizeof(WantedPixel)) return false;
  FurtherRays wanted(pixels, refining_.first_spp);
  for (size_t i = 0; i < pixels; ++i) {
    const auto w = in.next<WantedPixel>();
    if (w.samples < uint32_t(refining_.first_spp) ||
        w.samples > uint32_t(refining_.most.in_pixel) ||
        w.surrogates > (refining_.has_surrogates ? uint32_t(most_surrogates) : 0) ||
        !std::has_single_bit(w.effort_divisor) ||
        w.effort_divisor > refining_.options.most_effort_divisor)
      return false;
    wanted.set(i, w);
  }
  refining_.wanted = std::move(wanted);
  return true;
}

// True if the pixel has the numbers of samples that these steps produce.
bool Rendering::is_as_expected(uint32_t steps, int x, int y) const {
  uint32_t samples = std::min(uint32_t(refining_.first_spp), steps * samples_per_batch),
           surrogates = 0;
  if (steps > steps_.first) {
    const size_t i = refining_.records->index(x, y);
    const auto wanted = uint32_t(refining_.wanted->samples[i]);
    const uint32_t further = steps - steps_.first;
    if (refines_at_once()) {
      surrogates = uint32_t(refining_.wanted->surrogates[i]);
      if (further > steps_.surrogates) samples = wanted;
    } else {
      samples = std::min(wanted, uint32_t(refining_.first_spp) + further * samples_per_batch);
    }
  }
  return film_.estimate(x, y).samples == samples && film_.surrogates(x, y) == surrogates;
}

bool Rendering::restore_tile(ByteReader in) {
  if (in.left() < sizeof(TileHeader)) return false;
  const auto h = in.next<TileHeader>();
  if (h.tile >= book_.size() || book_.steps(h.tile) != 0 || h.steps == 0 ||
      h.steps > steps_.all() || (h.steps > steps_.first && !refining_.wanted))
    return false;
  const PixelRect& r = plan_.tiles[h.tile];
  for (int y = r.y0; y < r.y1; ++y)
    for (int x = r.x0; x < r.x1; ++x) {
      if (in.left() < film_.bytes_of_pixel() || !film_.load(x, y, in)) return false;
      if (refining_.records && !refining_.records->load(x, y, in)) return false;
      if (!is_as_expected(h.steps, x, y)) return false;
    }
  book_.restore(h.tile, {h.steps, h.counters});
  return in.left() == 0;
}

}  // namespace troffer
