// A time at which work is to end.
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <thread>

#include "base/parallel.h"

namespace troffer {

// Owns a flag that is set when another is, or when the time is up, whichever comes first. A thread
// of its own looks at both, a few hundred times a second.
class Deadline {
 public:
  using Clock = std::chrono::steady_clock;

  // `parent` must outlive this.
  Deadline(const StopFlag& parent, Clock::time_point end);
  ~Deadline();
  Deadline(const Deadline&) = delete;
  Deadline& operator=(const Deadline&) = delete;

  const StopFlag& flag() const { return flag_; }
  const StopFlag& parent() const { return parent_; }
  // The flag was set for the time, and nobody has set the parent since.
  bool is_over() const { return flag_.load() && !parent_.load(); }
  // Below zero once it is over.
  double seconds_left() const;
  // Sets the flag so much earlier: what is left to do then takes this long. By any thread.
  void keep_back(double seconds) { kept_back_ = seconds; }

 private:
  void watch();

  const StopFlag& parent_;
  const Clock::time_point end_;
  StopFlag flag_ = false;
  std::atomic<double> kept_back_ = 0;
  std::mutex mutex_;
  std::condition_variable ending_;
  bool is_ending_ = false;
  std::thread watcher_;  // last: it uses all the others
};

}  // namespace troffer
