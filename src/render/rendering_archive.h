// A rendering in progress as bytes: chunks of checkpoints, and messages between the processes of a
// group. Used by Rendering.
#pragma once

#include <cstdint>
#include <vector>

#include "base/own_file.h"
#include "render/checkpoint.h"
#include "render/film.h"
#include "render/further_rays.h"
#include "render/tile_book.h"

namespace troffer {

class RenderingArchive {
 public:
  // All arguments must outlive this object.
  RenderingArchive(const TilePlan& plan, Film& film, FurtherRays& further, TileBook& book)
      : plan_(plan), film_(film), further_(further), book_(book) {}

  // Appends the pixels of a tile, with their records.
  void save_tile(size_t tile, std::vector<uint8_t>& out) const;
  // Writes tiles one by one, while others are being worked on. This is consistent: a tile depends
  // on others only after all have finished a step, and restoring reproduces that state.
  void save(Checkpoint& checkpoint) const;
  // Restores what the checkpoint holds, and empties it. Throws InputError if it is impossible.
  void restore(Checkpoint& checkpoint);

  // Appends a tile for another process: its state and pixels. Records are part of it only during
  // the first pass; later steps do not change them.
  void send_tile(size_t tile, std::vector<uint8_t>& out) const;
  // Returns the state that send_tile() wrote; load_pixels() reads the pixels that follow.
  static TileBook::State received_state(ByteReader& in);
  void load_pixels(size_t tile, ByteReader& in);
  // Like send_tile(), followed by the rays planned for the tile; receive_brief() restores both.
  void send_brief(size_t tile, std::vector<uint8_t>& out) const;
  void receive_brief(size_t tile, ByteReader in);
  // Appends the records of all pixels; receive_records() reads them.
  void send_records(std::vector<uint8_t>& out) const;
  void receive_records(ByteReader in);

 private:
  bool restore_plan(ByteReader in);
  bool restore_tile(ByteReader in);
  bool is_as_expected(uint32_t steps, int x, int y) const;

  const TilePlan& plan_;
  Film& film_;
  FurtherRays& further_;
  TileBook& book_;
};

}  // namespace troffer
