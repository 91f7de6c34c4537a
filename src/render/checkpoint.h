// Checkpoint: a file from which an interrupted rendering continues, with the same bytes as result.
//
// It holds the progress of each tile (tile_book.h), its pixels, and the further rays planned for
// them once that is decided. Preparation is repeated, since it is deterministic. The file is
// replaced atomically, so that the last complete one survives a crash. Its contents are checked,
// since it may come from an untrusted source.
#pragma once

#include <atomic>
#include <chrono>
#include <functional>
#include <memory>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "image/atomic_file.h"
#include "render/picture_key.h"

namespace troffer {

// Share of a picture: part `part` of `parts`, counted from 1.
struct PictureShare {
  int part = 1, parts = 1;
  bool operator==(const PictureShare&) const = default;
};

// Writes and reads the checkpoint of one rendering. Threads may call take_turn() concurrently.
class Checkpoint {
 public:
  using Clock = std::chrono::steady_clock;
  // Receives one chunk after the other; no chunk is empty.
  using Add = std::function<void(std::span<const uint8_t>)>;
  using Fill = std::function<void(const Add&)>;
  using Warn = std::function<void(const std::string&)>;

  // interval: seconds between two writings; more if writing takes longer than a tenth of it. warn:
  // receives each distinct reason why the file could not be written, once.
  Checkpoint(std::string file, PictureKey key, PictureShare share, double interval, Warn warn);

  // Reads the file. Throws InputError if it is missing or damaged, or belongs to another picture,
  // share or program.
  void read();
  // Returns the chunks that were read, in order; empty if read() was not called.
  const std::vector<std::span<const uint8_t>>& chunks() const { return chunks_; }
  void forget_chunks();
  [[noreturn]] void refuse_chunks() const;  // throws InputError: the chunks hold impossible values

  // Returns true if the interval is over, to one caller at a time, who must then call write().
  bool take_turn();
  // Writes the file. If that fails, the old file stays, and `warn` receives the reason.
  void write(const Fill& fill);
  // Returns the reason why the last write() failed, or an empty string.
  const std::string& failure() const { return failure_; }

 private:
  void write_file(const Fill& fill) const;

  std::string file_;
  PictureKey key_;
  PictureShare share_;
  std::chrono::duration<double> interval_;
  Warn warn_;
  std::vector<uint8_t> bytes_;
  std::vector<std::span<const uint8_t>> chunks_;  // views of bytes_
  std::atomic<bool> is_writing_ = false;
  Clock::time_point next_;  // earliest time of the next writing
  std::string failure_;
  std::set<std::string> warned_;  // reasons already reported
};

}  // namespace troffer
