// A file from which a rendering that was broken off goes on, to the same bytes.
//
// It holds how far each tile is (tile_book.h), its pixels, and how many further rays the pixels
// are to get, once that is decided. What was prepared is made again, which is the same each time.
// The file is replaced as a whole: whenever the program or the machine ends, the last one is there.
// It may come from anybody: what is read is checked.
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

// Which share of a picture: the part-th of `parts`, counted from 1.
struct PictureShare {
  int part = 1, parts = 1;
  bool operator==(const PictureShare&) const = default;
};

class Checkpoint {
 public:
  using Clock = std::chrono::steady_clock;
  // Is given one chunk of what is to be kept after the other; none is empty.
  using Add = std::function<void(std::span<const uint8_t>)>;
  using Fill = std::function<void(const Add&)>;
  using Warn = std::function<void(const std::string&)>;

  // interval: seconds from one writing to the next; where it takes longer than a tenth of that,
  // more. warn: what could not be written, once for each reason.
  Checkpoint(std::string file, PictureKey key, PictureShare share, double interval, Warn warn);

  // Reads the file. InputError for one of another picture, share or program, one that is damaged,
  // or none.
  void read();
  // The chunks that were read, in order; none where nothing was.
  const std::vector<std::span<const uint8_t>>& chunks() const { return chunks_; }
  void forget_chunks();
  [[noreturn]] void refuse_chunks() const;  // InputError: they say what cannot be

  // True for one caller at a time, who is to call write() then: the interval is over.
  bool take_turn();
  // Where the file cannot be written, it stays as it was, and `warn` is told why.
  void write(const Fill& fill);
  // Why the last write() failed; empty: it did not.
  const std::string& failure() const { return failure_; }

 private:
  void write_file(const Fill& fill) const;

  std::string file_;
  PictureKey key_;
  PictureShare share_;
  std::chrono::duration<double> interval_;
  Warn warn_;
  std::vector<uint8_t> bytes_;
  std::vector<std::span<const uint8_t>> chunks_;  // of these
  std::atomic<bool> is_writing_ = false;
  Clock::time_point next_;  // not before this
  std::string failure_;
  std::set<std::string> warned_;  // of these reasons
};

}  // namespace troffer
