// How far the reading of a large file is.
#pragma once

#include <cstddef>
#include <functional>
#include <mutex>

namespace troffer {

// Is told fractions within [0,1], not twice at a time, on whatever thread. A scene that is read
// again around an origin of its own begins again.
using TellProgress = std::function<void(double fraction)>;

// Counts what is done by several threads, and tells it as a part [first, last] of the whole.
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

// How a file is read in pieces side by side, to the same end whatever these are.
struct PieceReading {
  size_t piece_bytes = size_t(1) << 18;  // about; 0: all in one
  TellProgress progress;                 // or none
};

// What the bytes of a file, and what stands in them, make of the whole.
constexpr double file_progress = 0.2;

}  // namespace troffer
