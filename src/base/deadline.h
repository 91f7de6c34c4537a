// Deadlines of timed work, as a stop flag. Used by renderers with a time limit; times are in
// seconds.
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <thread>

#include "base/parallel.h"

namespace troffer {

// Owns a flag that is set when `parent` is set or the time is up, whichever comes first. Its own
// thread checks both about 250 times a second.
class Deadline {
 public:
  using Clock = std::chrono::steady_clock;

  // `parent` must outlive this object.
  Deadline(const StopFlag& parent, Clock::time_point end);
  ~Deadline();
  Deadline(const Deadline&) = delete;
  Deadline& operator=(const Deadline&) = delete;

  const StopFlag& flag() const { return flag_; }
  const StopFlag& parent() const { return parent_; }
  // True if the flag was set for the time and the parent is still not set.
  bool is_over() const { return flag_.load() && !parent_.load(); }
  // Seconds until the end; negative afterwards.
  double seconds_left() const;
  // Sets the flag that much earlier, to leave time for the remaining work. Thread-safe.
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
  std::thread watcher_;  // last, because it uses all other members
};

}  // namespace troffer
