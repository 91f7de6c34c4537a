// Progress of reading large files, and the parameters of reading them in pieces. Used by the
// importers of OBJ, PLY and STL, which split their files among threads.
#pragma once

#include <cstddef>
#include <functional>
#include <mutex>

namespace troffer {

// Callback that receives fractions in [0,1], one call at a time, on any thread. It starts again
// from 0 if a scene is read a second time around an origin of its own.
using TellProgress = std::function<void(double fraction)>;

// Adds up the work of several threads and reports it as the part [first, last] of the whole.
// Thread-safe.
class ReadProgress {
 public:
  ReadProgress(const TellProgress& tell, double first, double last, size_t total)
      : tell_(tell), first_(first), size_(last - first), total_(total) {}

  void add(size_t done) {
    if (!tell_ || total_ == 0) return;
    const std::lock_guard lock(mutex_);
    done_ += done;
    tell_(first_ + size_ * double(done_) / double(total_));
  }

 private:
  const TellProgress& tell_;
  double first_, size_;
  size_t total_, done_ = 0;
  std::mutex mutex_;
};

// Parameters of reading a file in parallel pieces. The result does not depend on them.
struct PieceReading {
  size_t piece_bytes = size_t(1) << 18;  // approximate size; 0: one piece
  TellProgress progress;                 // may be empty
};

// Share of the progress for reading the bytes of a file; the rest is for parsing.
constexpr double file_progress = 0.2;

}  // namespace troffer
